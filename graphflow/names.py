"""ROS 2 names: what is legal, how relative and private names become full ones, and how remap rules change them.

The derivation of every name is kept, so that a user can be told why a topic is called what it is called.

Source: ROS 2 design articles "Topic and Service name mapping" and "Static remapping"; rcl `expand_topic_name`, `remap`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Literal

from graphflow.errors import InvalidName

Kind = Literal["topic", "service"]

_TOKEN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_NODE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_SUBSTITUTION = re.compile(r"\{([^}]*)\}")
MAX_LENGTH = 255
"""Characters in a full name, as in rmw."""
CHOICES_BOUND = 5_000
"""Choices that a word is compared with: other processes announce as many names as they like, and each takes 10 us."""


def nearest(word: str, choices: Iterable[str], *, cutoff: float = 0.6) -> str | None:
    """The choice most like `word`, or None when none is like it; `cutoff` is 1 for the very same.

    Args:
        choices: Of more than `CHOICES_BOUND`, the first are compared.
    """
    import difflib  # only after a mistake

    found = difflib.get_close_matches(word, list(islice(choices, CHOICES_BOUND)), n=1, cutoff=cutoff)
    return found[0] if found else None


def whole_rule(match: str, replacement: str, known: Iterable[str]) -> str:
    """A sentence that helps with a remap rule of the first part of names, as `turtle1:=turtle2`; else nothing.

    Args:
        known: The names that a node has.
    """
    head = match.strip("/") + "/"
    found = next((name for name in known if head != "/" and name.removeprefix("/").startswith(head)), None)
    if found is None:
        return ""
    rest = found.removeprefix("/").removeprefix(head)
    return f"; a rule has whole names: {found}:={replacement.rstrip('/')}/{rest}"


def did_you_mean(word: str, choices: Iterable[str], hidden: Iterable[str] = ()) -> str:
    """A sentence that helps with a misspelt `word`: the nearest choice, else all of a short list, else nothing.

    Args:
        hidden: Choices that are named only if they are near.
    """
    known = sorted(choices)
    best = nearest(word, [*known, *sorted(hidden)])
    if best is not None:
        return f"; did you mean {best!r}?"
    if 0 < len(known) <= 12:
        return "; there is " + ", ".join(known)
    return ""


def check_node_name(name: str) -> str:
    """`name` itself when a node may be called that.

    Raises:
        InvalidName: Anything but letters, digits and underscores, or a leading digit.
    """
    if not _NODE.match(name):
        raise InvalidName(
            f"{name!r} is not a node name: use letters, digits and _, and do not begin with a digit"
            + (f" (give the namespace {name.rpartition('/')[0] or '/'!r} separately)" if "/" in name else _legal(name))
        )
    return name


def check_full_name(name: str, what: str = "name") -> str:
    """`name` itself when it is a full topic, service or node name such as `/a/b`.

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
            return "it has // in it"
        if not _TOKEN.match(token):
            return f"{token!r} may have only letters, digits and _, and may not begin with a digit{_legal(token)}"
    return None


def _legal(token: str) -> str:
    """The end of a sentence on a part of a name that is not legal: one that is, and most like it."""
    near = re.sub(r"\W+", "_", token, flags=re.ASCII).strip("_")
    return f"; did you mean {near!r}?" if near != token and _NODE.match(near) else ""


def check_namespace(namespace: str) -> str:
    """The namespace in its full form (`/`, `/a/b`); a missing leading slash is added.

    Raises:
        InvalidName: It has parts that are not legal names.
    """
    if namespace in ("", "/"):
        return "/"
    full = namespace if namespace.startswith("/") else "/" + namespace
    return check_full_name(full, "namespace")


def join(namespace: str, name: str) -> str:
    """`name` inside `namespace`; an absolute name stays as it is."""
    if name.startswith("/"):
        return name
    return f"/{name}" if namespace == "/" else f"{namespace}/{name}"


def split(full_name: str) -> tuple[str, str]:
    """A full name as (namespace, last part): `/a/b` is (`/a`, `b`), `/b` is (`/`, `b`)."""
    namespace, _, last = full_name.rpartition("/")
    return namespace or "/", last


def is_hidden(name: str) -> bool:
    """Whether a part of the name begins with an underscore; listings leave such names out."""
    return any(part.startswith("_") for part in name.split("/"))


def expand(name: str, namespace: str, node: str) -> str:
    """The full name of `name` as used by node `node` in `namespace`, before any remap.

    Absolute names stay, relative ones join the namespace, `~` is the node, `{node}` and `{ns}` are substituted.

    Raises:
        InvalidName: The result is not a legal name.
    """
    text = _SUBSTITUTION.sub(lambda m: _substitute(m.group(1), name, namespace, node), name)
    if namespace == "/" and text.startswith("//"):  # {ns}/a at the root
        text = text[1:]
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
        raise InvalidName(f"{name!r} has {{{word}}} in it; only {{node}} and {{ns}} are known")
    return values[word]


@dataclass(frozen=True, slots=True)
class Remap:
    r"""One rule `match:=replacement`, perhaps for one node only, perhaps for one kind of name only.

    In `match`, `*` stands for one part of a name and `**` for any number of them: `/turtle1/**:=/robot/\1`.
    """

    match: str
    replacement: str
    r"""May have `\1` and so on, for what the wildcards stand for."""
    node: str | None = None
    kind: Kind | None = None
    source: str = ""
    """Where the rule was written, for messages."""

    def __str__(self) -> str:
        prefix = f"{self.node}:" if self.node else ""
        return f"{prefix}{self.match}:={self.replacement}"

    @classmethod
    def parse(cls, text: str, source: str = "") -> Remap:
        """A rule from the command line: `from:=to`, `node:from:=to`, `__ns:=/ns`, `__node:=name`.

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
            near = nearest(match, known)
            meant = f"; did you mean '{near}:={replacement}'?" if near else did_you_mean(match, known)
            raise InvalidName(f"{match!r} is not a remap key{meant}")
        return cls(match, replacement, node, kind, source)


_STAND_INS = {"*": "wildcardOne", "**": "wildcardMany"}
"""Legal parts of a name, in the place of wildcards while a rule is made a full name."""
_WILDCARDS = {"wildcardOne": "/([^/]+)", "wildcardMany": "((?:/[^/]+)*)"}


_REFERENCE = re.compile(r"\\(\d)")


def check_references(replacement: str, pattern: re.Pattern[str]) -> None:
    r"""Check that a replacement refers, by `\1` and so on, to wildcards that there are.

    Raises:
        InvalidName: It does not.
    """
    for number in _REFERENCE.findall(replacement):
        if not 0 < int(number) <= pattern.groups:
            raise InvalidName(f"{replacement} has \\{number}, for which the rule has no wildcard")


def _filled(replacement: str, found: re.Match[str]) -> str:
    """A replacement with what the wildcards stand for.

    Raises:
        InvalidName: It asks for one that is not there.
    """
    check_references(replacement, found.re)
    text = _REFERENCE.sub(lambda reference: found[int(reference[1])].removeprefix("/"), replacement)
    return text if text == replacement else re.sub("//+", "/", text).removesuffix("/") or "/"


@dataclass(frozen=True, slots=True)
class Resolution:
    """How a name came to be: what was written, its full form, and the rule that changed it, if one did."""

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
    """The names of one node: its own, and every name it uses.

    Args:
        name: The node's name before `__node` rules.
        namespace: Its namespace before `__ns` rules.
        rules: In order of precedence; the first that matches wins, and its result is not remapped again.
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
        """The full name before any remap. Raises InvalidName when it is not legal."""
        return expand(name, self.namespace, self.name)

    def pattern(self, match: str) -> re.Pattern[str]:
        """What the full names are like that a rule matches. Raises InvalidName when its match is not legal."""
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
        """The full, remapped name.

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
        """Rules meant for this node that none of its names has matched so far."""
        return [rule for rule in self.rules if rule not in self.used]
