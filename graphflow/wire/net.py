"""The announcement of net profiles: a link tells the commands of this machine which profile is in force.

@graphflow/<domain>/net/<zid>/<file>/<patterns>      a token, with file and patterns quoted; graphflow's own keys
                                                     never leave the machine
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple
from urllib.parse import quote, unquote

from graphflow.errors import printable

TOKEN_BOUND = 1 << 16
"""Longest token that is read, in characters."""


class NetToken(NamedTuple):
    """A net profile in force."""

    file: str
    allow: tuple[str, ...]
    """Patterns of names: `*` matches one part, `**` any number of them."""

    def passes(self, name: str) -> bool:
        """Return whether a topic or service may pass."""
        return any(_matches(pattern, name) for pattern in self.allow)

    def __str__(self) -> str:
        return f"the net profile {self.file}, which allows {', '.join(self.allow)}"


def token(domain: int, zid: str, file: str, allow: Iterable[str]) -> str:
    """Return the token of a link."""
    return f"@graphflow/{domain}/net/{zid}/{quote(file, safe='')}/{quote(' '.join(allow), safe='')}"


def watch_key(domain: int) -> str:
    """Return the key that matches the tokens of all links of a domain."""
    return f"@graphflow/{domain}/net/**"


def refusal(name: str, profiles: Iterable[NetToken]) -> str:
    """Describe which net profile keeps a topic or service on its machine, and the remedy; empty if none does."""
    blocking = next((profile for profile in profiles if not profile.passes(name)), None)
    if blocking is None:
        return ""
    return f"{name} does not pass {blocking}; if its node is on another machine, add it to `allow` on both"


def parse(text: str) -> NetToken | None:
    """Read a token; None if the text is not one."""
    parts = text.split("/") if len(text) <= TOKEN_BOUND else []
    if len(parts) != 6 or parts[0] != "@graphflow" or parts[2] != "net":
        return None
    return NetToken(printable(unquote(parts[4])), tuple(printable(unquote(parts[5])).split()))


def _matches(pattern: str, name: str) -> bool:
    """Return whether a name matches a pattern, in time O(pattern * name), since any process may announce patterns."""
    parts, names = pattern.split("/")[1:], name.split("/")[1:]
    at = there = 0
    star, matched = -1, 0  # the last `**`, and the end of its match so far: backtracking only to the last one suffices
    while there < len(names):
        if at < len(parts) and parts[at] == "**":
            star, matched, at = at, there, at + 1
        elif at < len(parts) and parts[at] in ("*", names[there]):
            at, there = at + 1, there + 1
        elif star >= 0:
            matched += 1
            at, there = star + 1, matched
        else:
            return False
    return all(part == "**" for part in parts[at:])
