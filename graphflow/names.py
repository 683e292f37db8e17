"""ROS 2 names: their rules, the expansion of relative and private names, and remapping.

The derivation of every name is kept, so that its origin can be explained to users.

Source: ROS 2 design articles "Topic and Service name mapping" and "Static remapping"; rcl `expand_topic_name`, `remap`.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Literal

from graphflow.errors import InvalidName

Kind = Literal["topic", "service"]

_TOKEN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_NODE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_SUBSTITUTION = re.compile(r"\{([^}]*)\}")
MAX_LENGTH = 255
"""Length limit in characters of a full name, as in rmw."""
EVERYBODYS = ("/rosout", "/parameter_events", "/clock", "/tf", "/tf_static")
"""Topics that many nodes have and that need no counterpart."""
CHOICES_BOUND = 5_000
"""Number of choices that a word is compared with: others may announce any number of names, and each takes 10 us."""


def nearest(word: str, choices: Iterable[str], *, cutoff: float = 0.6) -> str | None:
    """Return the choice most similar to a word; None if none is similar.

    Args:
        choices: Only the first `CHOICES_BOUND` are compared.
        cutoff: The least similarity, up to 1 for equality.
    """
    import difflib  # only after a mistake

    found = difflib.get_close_matches(word, list(islice(choices, CHOICES_BOUND)), n=1, cutoff=cutoff)
    return found[0] if found else None


_KEYS = {"ns": "__ns", "namespace": "__ns", "name": "__node", "node": "__node"}
"""Words that are written for the keys of a node's namespace and name."""


def rule_hint(match: str, replacement: str, known: Collection[str]) -> str:
    """Return a hint for a remap rule that matches no name of a node; empty if its purpose is not seen.

    Args:
        known: The names of the node.
    """
    if match in _KEYS:
        return f"; did you mean {_KEYS[match]}:={replacement}?"
    is_known = replacement in known or f"/{replacement}" in known
    is_alike = match.rpartition("/")[2] == replacement.rpartition("/")[2]
    if is_known and (is_alike or nearest(match, known) is None):
        return f"; it is the other way round, from the node's name: {replacement}:={match}"
    head = match.strip("/") + "/"
    found = next((name for name in known if head != "/" and name.removeprefix("/").startswith(head)), None)
    if found is None:
        return ""
    rest = found.removeprefix("/").removeprefix(head)
    return f"; a rule has whole names: {found}:={replacement.rstrip('/')}/{rest}"


def did_you_mean(word: str, choices: Iterable[str], hidden: Iterable[str] = ()) -> str:
    """Return a hint for a misspelt word: the nearest choice, else all of a short list, else empty.

    Args:
        hidden: Further choices, which are named only as the nearest one.
    """
    known = sorted(choices)
    best = nearest(word, [*known, *sorted(hidden)])
    if best is not None:
        return f"; did you mean {best!r}?"
    if 0 < len(known) <= 12:
        return "; there is " + ", ".join(known)
    return ""


def without_slash(name: str) -> str:
    """Return the remedy for an absolute name that was meant within a namespace, without its verb."""
    return f"{name[1:]!r}: a slash in front keeps the namespace out"


def check_node_name(name: str) -> str:
    """Check the name of a node, and return it.

    Raises:
        InvalidName: The name has other characters than letters, digits and underscores, or begins with a digit.
    """
    if not isinstance(name, str):
        raise InvalidName(f"{name!r} is not a node name: write a text, or nothing for the name of the class")
    if not _NODE.match(name):
        raise InvalidName(
            f"{name!r} is not a node name: use letters, digits and _, and do not begin with a digit"
            + (f" (give the namespace {name.rpartition('/')[0] or '/'!r} separately)" if "/" in name else _legal(name))
        )
    return name


def check_full_name(name: str, what: str = "name") -> str:
    """Check a full topic, service or node name such as `/a/b`, and return it.

    Raises:
        InvalidName: It does not begin with `/`, ends with `/`, or a part is empty or has a wrong character.
    """
    problem = _fault(name)
    if problem:
        raise InvalidName(f"{name!r} is not a {what}: {problem}")
    return name


def _fault(name: str) -> str | None:
    if not name.startswith("/"):
        return "a full name begins with /"
    if len(name) > MAX_LENGTH:
        return f"it is longer than {MAX_LENGTH} characters"
    if name.endswith("/"):
        return "it ends with /"
    for token in name[1:].split("/"):
        if not token:
            return f"it has // in it; did you mean {re.sub('//+', '/', name)!r}?"
        if not _TOKEN.match(token):
            return f"{token!r} may have only letters, digits and _, and may not begin with a digit{_legal(token)}"
    return None


def _legal(token: str) -> str:
    """Return a hint for an illegal part of a name: the most similar legal one."""
    near = re.sub(r"\W+", "_", token, flags=re.ASCII).strip("_")
    return f"; did you mean {near!r}?" if near != token and _NODE.match(near) else ""


def check_namespace(namespace: str) -> str:
    """Check a namespace, and return it with a leading slash (`/`, `/a/b`).

    Raises:
        InvalidName: A part is not a legal name.
    """
    if namespace in ("", "/"):
        return "/"
    full = namespace if namespace.startswith("/") else "/" + namespace
    return check_full_name(full, "namespace")


def join(namespace: str, name: str) -> str:
    """Return a name within a namespace; an absolute name is returned unchanged."""
    if name.startswith("/"):
        return name
    return f"/{name}" if namespace == "/" else f"{namespace}/{name}"


def split(full_name: str) -> tuple[str, str]:
    """Split a full name into namespace and last part: `/a/b` into (`/a`, `b`), `/b` into (`/`, `b`)."""
    namespace, _, last = full_name.rpartition("/")
    return namespace or "/", last


def is_hidden(name: str) -> bool:
    """Return whether a part of a name begins with an underscore; listings omit such names."""
    return any(part.startswith("_") for part in name.split("/"))


def is_everybodys(topic: str) -> bool:
    """Whether a topic belongs to ROS or graphflow, so that users do not write its name."""
    return topic in EVERYBODYS or is_hidden(topic)


def expand(name: str, namespace: str, node: str) -> str:
    """Expand a name as used by a node in a namespace to its full name, before any remap.

    Absolute names stay, relative ones join the namespace, `~` is the node, `{node}` and `{ns}` are substituted.

    Raises:
        InvalidName: The result is not a legal name.
    """
    text = _SUBSTITUTION.sub(lambda m: _substitute(m.group(1), name, namespace, node), name)
    if namespace == "/" and name.startswith("{"):  # {ns}/a at the root
        text = text.replace("//", "/", 1)
    if text == "~":
        text = join(namespace, node)
    elif text.startswith("~/"):
        text = f"{join(namespace, node)}{text[1:]}"
    problem = "it is empty" if not text else _fault(join(namespace, text))
    if problem:
        raise InvalidName(f"{name!r} is not a topic or service name: {problem}")
    return join(namespace, text)


def _substitute(word: str, name: str, namespace: str, node: str) -> str:
    values = {"node": node, "ns": namespace, "namespace": namespace}
    if word not in values:
        if " " in name:
            first = name.split()[0]
            raise InvalidName(f"{name!r} has spaces in it; the name ends at {first!r}, so write the name alone")
        raise InvalidName(f"{name!r} has {{{word}}} in it; only {{node}} and {{ns}} are known")
    return values[word]


@dataclass(frozen=True, slots=True)
class Remap:
    r"""A rule `match:=replacement`, perhaps for only one node or one kind of name.

    In `match`, `*` matches one part of a name and `**` any number of them: `/turtle1/**:=/robot/\1`.
    """

    match: str
    replacement: str
    r"""The new name; `\1` and so on are the matches of the wildcards."""
    node: str | None = None
    kind: Kind | None = None
    source: str = ""
    """The origin of the rule, for messages."""

    def __str__(self) -> str:
        prefix = f"{self.node}:" if self.node else ""
        return f"{prefix}{self.match}:={self.replacement}"

    @classmethod
    def parse(cls, text: str, source: str = "") -> Remap:
        """Parse a rule of the command line: `from:=to`, `node:from:=to`, `__ns:=/ns`, `__node:=name`.

        Raises:
            InvalidName: There is no `:=`, a side is empty, `node` is not a node name, or `__word` is not a known one.
        """
        match, arrow, replacement = text.partition(":=")
        if arrow and match and not replacement:
            raise InvalidName(f"{text!r}: the name is missing; write it behind := without a space")
        if not arrow or not match:
            head, equals, rest = text.partition("=")
            way = f": {head}:={rest}" if not arrow and equals else ", for example pose:=/turtle1/pose"
            raise InvalidName(f"{text!r} is not a remap rule; write it as from:=to{way}")
        node: str | None = None
        head, colon, rest = match.partition(":")
        if colon and not rest.startswith("//"):
            node, match = check_node_name(head), rest
        kind: Kind | None = None
        for scheme, meant in (("rostopic://", "topic"), ("rosservice://", "service")):
            if match.startswith(scheme):
                match, kind = match.removeprefix(scheme), meant  # type: ignore[assignment]
        if match.startswith("__") and match not in ("__ns", "__node", "__name"):
            known = ("__ns", "__node", "__name")
            near = _KEYS.get(match.strip("_")) or nearest(match, known)
            meant = f"; did you mean '{near}:={replacement}'?" if near else did_you_mean(match, known)
            raise InvalidName(f"{match!r} is not a remap key{meant}")
        return cls(match, replacement, node, kind, source)


_STAND_INS = {"*": "wildcardOne", "**": "wildcardMany"}
"""Legal parts of a name that replace wildcards while a rule is expanded to a full name."""
_WILDCARDS = {"wildcardOne": "/([^/]+)", "wildcardMany": "((?:/[^/]+)*)"}


_REFERENCE = re.compile(r"\\(\d)")


def check_references(replacement: str, pattern: re.Pattern[str]) -> None:
    r"""Check that the references of a replacement, `\1` and so on, are to wildcards of the rule.

    Raises:
        InvalidName: The rule has no such wildcard.
    """
    for number in _REFERENCE.findall(replacement):
        if not 0 < int(number) <= pattern.groups:
            raise InvalidName(f"{replacement} has \\{number}, for which the rule has no wildcard")


def _filled(replacement: str, found: re.Match[str]) -> str:
    """Substitute the matches of wildcards in a replacement.

    Raises:
        InvalidName: The rule has no such wildcard.
    """
    check_references(replacement, found.re)
    text = _REFERENCE.sub(lambda reference: found[int(reference[1])].removeprefix("/"), replacement)
    return text if text == replacement else re.sub("//+", "/", text).removesuffix("/") or "/"


@dataclass(frozen=True, slots=True)
class Resolution:
    """The derivation of a name: as given, expanded, and resolved by a rule, if one matched."""

    given: str
    expanded: str
    resolved: str
    rule: Remap | None = None

    def __str__(self) -> str:
        steps = [self.given]
        if self.expanded != self.given:
            steps.append(self.expanded)
        if self.rule is not None:
            origin = f" from {self.rule.source}" if self.rule.source else ""
            steps.append(f"{self.resolved} (remap {self.rule}{origin})")
        return " -> ".join(steps)


@dataclass(slots=True)
class Resolver:
    """The names of a node: its own, and every name that it uses.

    Args:
        name: The node's name before `__node` rules.
        namespace: Its namespace before `__ns` rules.
        rules: Remap rules; the first that matches wins, and its result is not remapped again.
    """

    name: str
    namespace: str
    rules: Sequence[Remap] = ()
    used: set[Remap] = field(default_factory=set)
    derivations: dict[str, Resolution] = field(default_factory=dict)
    """Every name resolved so far, by its full form before remapping."""

    def __post_init__(self) -> None:
        original = self.name
        for rule in self.rules:
            if rule.match in ("__node", "__name") and rule.node in (None, original):
                self.name = rule.replacement
                self.used.add(rule)
                break
        for rule in self.rules:
            if rule.match == "__ns" and rule.node in (None, original, self.name):
                self.namespace = rule.replacement
                self.used.add(rule)
                break
        check_node_name(self.name)
        self.namespace = check_namespace(self.namespace)
        self.rules = [r for r in self.rules if r.node in (None, original, self.name) and not r.match.startswith("__")]

    @property
    def full_name(self) -> str:
        return join(self.namespace, self.name)

    def full(self, name: str) -> str:
        """Return a full name before any remap. Raises InvalidName if it is not legal."""
        return expand(name, self.namespace, self.name)

    def pattern(self, match: str) -> re.Pattern[str]:
        """Return the pattern of the full names that a rule matches. Raises InvalidName if its match is not legal."""
        if "*" not in match:
            return re.compile(re.escape(self.full(match)))
        try:
            full = self.full("/".join(_STAND_INS.get(token, token) for token in match.split("/")))
        except InvalidName:
            raise InvalidName(
                f"{match!r}: a wildcard stands for whole parts of a name, as in */pose or /a/**"
            ) from None
        return re.compile("".join(_WILDCARDS.get(token, f"/{token}") for token in full[1:].split("/")))

    def resolve(self, name: str, kind: Kind = "topic") -> str:
        """Return the full, remapped name.

        Raises:
            InvalidName: `name`, or a rule that applies to it, is not legal.
        """
        expanded = self.full(name)
        for rule in self.rules:
            if rule.kind in (None, kind) and (found := self.pattern(rule.match).fullmatch(expanded)):
                self.used.add(rule)
                resolved = self.full(_filled(rule.replacement, found))
                self.derivations[expanded] = Resolution(name, expanded, resolved, rule)
                return resolved
        self.derivations[expanded] = Resolution(name, expanded, expanded)
        return expanded

    def unused(self) -> list[Remap]:
        """Return the rules for this node that have matched none of its names so far."""
        return [rule for rule in self.rules if rule not in self.used]

    def taken_by(self, rule: Remap) -> Remap | None:
        """Return the earlier rule that has matched a name which a rule matches, too; None if there is none."""
        pattern = self.pattern(rule.match)
        taken = (found.rule for found in self.derivations.values() if pattern.fullmatch(found.expanded))
        return next((other for other in taken if other not in (None, rule)), None)
