"""Liveliness tokens: the announcements of nodes and endpoints, with their QoS in a few characters.

    @ros2_lv/<domain>/<zid>/<nid>/<nid>/NN/<enclave>/<namespace>/<node>
    @ros2_lv/<domain>/<zid>/<nid>/<eid>/MP|MS|SS|SC/<enclave>/<namespace>/<node>/<name>/<type>/<hash>/<qos>

Every `/` inside a chunk is written `%`. Parsing is lenient, as peers of other versions append chunks and values.

Source: rmw_zenoh design document, "Graph cache"; rmw_zenoh liveliness_utils.
"""

from __future__ import annotations

from enum import StrEnum
from functools import cached_property, lru_cache
from typing import NamedTuple

from graphflow.names import join
from graphflow.qos import DEFAULT_DEPTH, INFINITE_NS, Durability, History, Liveliness, Qos, Reliability
from graphflow.wire import keyexpr
from graphflow.wire.gid import gid

ADMIN_SPACE = "@ros2_lv"
TOKEN_BOUND = 4_000
"""Longest token in characters: four names of the greatest length, and room."""


_LARGEST = 2**64 - 1
_DIGITS = len(str(_LARGEST))


class Kind(StrEnum):
    NODE = "NN"
    PUBLISHER = "MP"
    SUBSCRIPTION = "MS"
    SERVICE = "SS"
    CLIENT = "SC"


NODES = f"{ADMIN_SPACE}/*/*/*/*/{Kind.NODE}/**"
"""The key that matches the tokens of all nodes in all domains."""
ALL = f"{ADMIN_SPACE}/**"
"""The key that matches all tokens in all domains."""


def _mangle(name: str) -> str:
    return name.replace("/", "%")


def _demangle(name: str) -> str:
    return name.replace("%", "/")


class _Entity(NamedTuple):
    domain: int
    zid: str
    nid: int
    eid: int
    kind: Kind
    namespace: str
    node: str
    name: str = ""
    type: str = ""
    hash: str = ""
    qos: Qos = Qos(depth=DEFAULT_DEPTH)
    enclave: str = "/"


class Entity(_Entity):
    """A node (then `name`, `type` and `hash` are empty) or one of its endpoints."""

    @property
    def node_name(self) -> str:
        """The full name of the node."""
        return join(self.namespace, self.node)

    @cached_property
    def token(self) -> str:
        """The token; of a parsed entity exactly as received, since its GID is a hash of that."""
        parts = [
            ADMIN_SPACE,
            str(self.domain),
            self.zid,
            str(self.nid),
            str(self.eid),
            self.kind.value,
            _mangle(self.enclave),
            _mangle(self.namespace),
            self.node,
        ]
        if self.kind is not Kind.NODE:
            parts += [_mangle(self.name), keyexpr.dds_type(self.type), self.hash, qos_chunk(self.qos)]
        return "/".join(parts)

    @cached_property
    def gid(self) -> bytes:
        return gid(self.token)

    @property
    def data_key(self) -> str:
        return str(keyexpr.DataKey(self.domain, self.name, self.type, self.hash))


def watch_key(domain: int) -> str:
    """Return the key that matches all tokens of a domain."""
    return f"{ADMIN_SPACE}/{domain}/**"


def whole_number(text: str) -> int | None:
    """Parse a number from the network, of 64 bits at most; None for anything else. Long texts are never converted."""
    if not (text.isascii() and text.isdecimal() and len(text) <= _DIGITS):
        return None
    number = int(text)
    return number if number <= _LARGEST else None


_KINDS = {kind.value: kind for kind in Kind}


def parse_token(token: str) -> Entity | None:
    """Parse a token; None if it announces nothing known here."""
    if len(token) > TOKEN_BOUND or not token.isprintable():
        return None
    parts = token.split("/")
    if len(parts) < 9 or parts[0] != ADMIN_SPACE or not all(parts):
        return None
    _, domain, zid, nid, eid, kind, enclave, namespace, node = parts[:9]
    domain_, nid_, eid_, kind_ = whole_number(domain), whole_number(nid), whole_number(eid), _KINDS.get(kind)
    if kind_ is None or domain_ is None or nid_ is None or eid_ is None:
        return None
    head = (domain_, zid, nid_, eid_, kind_, _demangle(namespace), node)
    if kind_ is Kind.NODE:
        entity = Entity(*head, enclave=_demangle(enclave))
    elif len(parts) < 13:
        return None
    else:
        name, type_, hash_, qos = parts[9:13]
        entity = Entity(*head, _demangle(name), keyexpr.ros_type(type_), hash_, parse_qos(qos), _demangle(enclave))
    entity.token = token
    return entity


_SECOND = 1_000_000_000


def qos_chunk(qos: Qos) -> str:
    """Encode a profile for a token: values that equal rmw_zenoh's defaults are left empty."""

    def unless(value: int, default: int) -> str:
        return "" if value == default else str(value)

    def span(ns: int) -> str:
        sec, nsec = divmod(ns, _SECOND)
        return f"{unless(sec, INFINITE_NS // _SECOND)},{unless(nsec, INFINITE_NS % _SECOND)}"

    return ":".join(
        [
            unless(qos.reliability, Reliability.RELIABLE),
            unless(qos.durability, Durability.VOLATILE),
            f"{unless(qos.history, History.KEEP_LAST)},{unless(qos.depth, DEFAULT_DEPTH)}",
            span(qos.deadline_ns),
            span(qos.lifespan_ns),
            f"{unless(qos.liveliness, Liveliness.AUTOMATIC)},{span(qos.lease_ns)}",
        ]
    )


@lru_cache(maxsize=256)  # a graph uses few different profiles in thousands of tokens
def parse_qos(chunk: str) -> Qos:
    """Parse a QoS chunk; missing or unknown values get their defaults."""
    fields = [part.split(",") for part in chunk.split(":")]

    def number(field: int, part: int, default: int) -> int:
        try:
            found = whole_number(fields[field][part])
        except IndexError:
            return default
        return default if found is None else found

    def span(field: int, part: int) -> int:
        sec = number(field, part, INFINITE_NS // _SECOND)
        return min(INFINITE_NS, sec * _SECOND + number(field, part + 1, INFINITE_NS % _SECOND))

    return Qos(
        depth=number(2, 1, DEFAULT_DEPTH),
        reliability=Reliability.BEST_EFFORT if number(0, 0, 1) == Reliability.BEST_EFFORT else Reliability.RELIABLE,
        durability=Durability.TRANSIENT_LOCAL if number(1, 0, 2) == Durability.TRANSIENT_LOCAL else Durability.VOLATILE,
        history=History.KEEP_ALL if number(2, 0, 1) == History.KEEP_ALL else History.KEEP_LAST,
        deadline_ns=span(3, 0),
        lifespan_ns=span(4, 0),
        liveliness=Liveliness.MANUAL_BY_TOPIC
        if number(5, 0, 1) == Liveliness.MANUAL_BY_TOPIC
        else Liveliness.AUTOMATIC,
        lease_ns=span(5, 1),
    )
