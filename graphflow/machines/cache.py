"""The graph cache: the nodes and endpoints of a domain, derived from liveliness tokens.

Zenoh announces tokens in any order and may repeat them, so every event is idempotent: a token that is known is ignored,
and so is the end of one that is not.

Source: rmw_zenoh graph_cache; the queries are those of rmw's graph functions.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from graphflow.names import did_you_mean, is_everybodys, is_hidden, nearest, without_slash
from graphflow.wire.liveliness import Entity, Kind, parse_token

ACTION_FEEDBACK = "/_action/feedback"
ACTION_SEND_GOAL = "/_action/send_goal"
ACTION_FEEDBACK_TYPE = "_FeedbackMessage"
_OF_EVERY_NODE = ("rcl_interfaces/srv/", "type_description_interfaces/srv/")
"""Packages of the service types that every node offers by itself."""
TOKENS_BOUND = 100_000
"""Tokens of a domain that are kept, at most."""
_SHOWN = 3
"""Most names of a namespace or type that a message lists."""
_HARDLY_DIFFERENT = 0.8
"""Least similarity (0 to 1) of a name of another type to the one that was written."""


class GraphChange(NamedTuple):
    """An entity that came (`alive`) or went."""

    entity: Entity
    alive: bool


class GraphCache:
    """The nodes and endpoints of one domain."""

    def __init__(self, tokens: Iterable[str] = ()) -> None:
        self._entities: dict[str, Entity] = {}
        self._of_node: dict[tuple[str, int], dict[str, None]] = {}
        """By node: its own token and those of its endpoints, in order of arrival."""
        self._named: dict[str, dict[str, Entity]] = {}
        """By name: the endpoints, by token. An index, since a process searches by name for each endpoint it opens."""
        self.refused = 0
        """Tokens that are malformed, or beyond `TOKENS_BOUND`."""
        for token in tokens:
            self.apply(token, alive=True)

    def __repr__(self) -> str:
        return f"<GraphCache {len(self.nodes())} nodes, {len(self._entities)} tokens>"

    def apply(self, token: str, *, alive: bool) -> list[GraphChange]:
        """Apply one token event; return the changes, none for a repeated or unknown token.

        The end of a node's token ends its endpoints too: their own tokens may end later, or not at all.
        """
        if not alive:
            gone = self._pop(token)
            if gone is None:
                return []
            changes, node = [GraphChange(gone, False)], (gone.zid, gone.nid)
            rest = self._of_node[node]
            del rest[token]
            if gone.kind is Kind.NODE:
                changes += [GraphChange(other, False) for t in rest if (other := self._pop(t)) is not None]
                rest = {}
            if not rest:
                del self._of_node[node]
            return changes
        if token in self._entities:
            return []
        entity = parse_token(token) if len(self._entities) < TOKENS_BOUND else None
        if entity is None:
            self.refused += 1
            return []
        self._entities[token] = entity
        self._named.setdefault(entity.name, {})[token] = entity
        self._of_node.setdefault((entity.zid, entity.nid), {})[token] = None
        return [GraphChange(entity, True)]

    def _pop(self, token: str) -> Entity | None:
        entity = self._entities.pop(token, None)
        if entity is not None:
            same = self._named[entity.name]
            del same[token]
            if not same:
                del self._named[entity.name]
        return entity

    def __iter__(self) -> Iterator[Entity]:
        return iter(self._entities.values())

    def __contains__(self, token: str) -> bool:
        return token in self._entities

    def nodes(self, *, hidden: bool = True) -> list[str]:
        """Return the full names of the nodes, sorted; a name that several nodes share appears once for each."""
        names = {(e.zid, e.nid): e.node_name for e in self}
        return sorted(n for n in names.values() if hidden or not is_hidden(n))

    def endpoints(self, kind: Kind, name: str | None = None, node: str | None = None) -> list[Entity]:
        """Return the endpoints of a kind, of one topic or service, of one node; in a stable order."""
        among = self if name is None else self._named.get(name, {}).values()
        found = [e for e in among if e.kind is kind and (node is None or e.node_name == node)]
        return sorted(found, key=lambda e: (e.name, e.node_name, e.type, e.eid))

    def named(self, name: str) -> list[Entity]:
        """Return the endpoints of one topic or service, of any kind."""
        return sorted(self._named.get(name, {}).values(), key=lambda e: (e.kind, e.node_name, e.eid))

    def owners(self, name: str) -> list[Entity]:
        """Return the entities of all nodes called `name`."""
        return [e for e in self._named.get("", {}).values() if e.node_name == name]

    def topics(self, *, hidden: bool = False) -> dict[str, list[str]]:
        """Return the types by topic, both sorted."""
        return self._types(Kind.PUBLISHER, Kind.SUBSCRIPTION, hidden=hidden)

    def services(self, *, hidden: bool = False) -> dict[str, list[str]]:
        """Return the types by service that a server offers or a client uses, both sorted."""
        return self._types(Kind.SERVICE, Kind.CLIENT, hidden=hidden)

    def offered(self) -> tuple[set[str], set[str]]:
        """Return the services that have a server: those of users, and those that are hidden or that every node has."""
        servers = self.endpoints(Kind.SERVICE)
        inner = {e.name for e in servers if e.type.startswith(_OF_EVERY_NODE) or is_hidden(e.name)}
        return {e.name for e in servers} - inner, inner

    def actions(self) -> dict[str, list[str]]:
        """Return the types by action, derived from the feedback topics."""
        return {
            name.removesuffix(ACTION_FEEDBACK): [t.removesuffix(ACTION_FEEDBACK_TYPE) for t in types]
            for name, types in self.topics(hidden=True).items()
            if name.endswith(ACTION_FEEDBACK)
        }

    def served_actions(self) -> list[str]:
        """Return the actions that have a server; `actions` includes those that only clients name."""
        topics = {entity.name for entity in self.endpoints(Kind.PUBLISHER)}
        return [name for name in self.actions() if f"{name}{ACTION_FEEDBACK}" in topics]

    def instead(self, name: str, known: Iterable[str], hidden: Iterable[str] = ()) -> str:
        """Return the end of a message about an unknown name: what has it, what is below it, or a similar name.

        Args:
            known: Names of the wanted kind, to suggest from; `hidden` are suggested only if they are near.
        """
        topics, services, actions = self.topics(hidden=True), self.services(hidden=True), self.actions()
        for kind, names in (("a topic", topics), ("a service", services), ("an action", actions)):
            if name in names:
                return f"; it is {kind}, of type {' and '.join(names[name])}"
        if name in self.nodes():
            return "; it is a node"
        known = list(known)
        if absolute := self.absolute(name):
            return absolute
        if inside := [other for other in known if other.startswith(f"{name.rstrip('/')}/") and name != "/"]:
            more = f" and {len(inside) - _SHOWN} more" if len(inside) > _SHOWN else ""
            return f"; it is a namespace, with {', '.join(inside[:_SHOWN])}{more}"
        return did_you_mean(name, known, hidden)

    def absolute(self, name: str) -> str:
        """Return the end of a message about an unknown name that a node has without its namespace; empty for others."""
        for entity in self:
            if entity.namespace and name == entity.namespace + entity.name and not is_everybodys(entity.name):
                return f"; {entity.node_name} has {entity.name}, and needs {without_slash(entity.name)}"
        return ""

    def service_of_type(self, name: str, type_name: str) -> str:
        """Return the end of a message that no node offers a service of a type: the services that may be meant."""
        types = self._types(Kind.SERVICE, hidden=False)
        return _of_type(name, type_name, types, self.offered()[0])

    def action_of_type(self, name: str, type_name: str) -> str:
        """Return the end of a message that no node offers an action of a type: the actions that may be meant."""
        types, served = self.actions(), set(self.served_actions()) - {name}
        return _of_type(name, type_name, {action: types[action] for action in served}, served)

    def unpublished(self, topic: str) -> str:
        """Return a message that a topic has no publisher, with a suggestion unless it has subscriptions."""
        if self.endpoints(Kind.SUBSCRIPTION, topic):
            return f"topic [{topic}] has subscriptions, and no publisher yet{self.absolute(topic)}"
        return f"topic [{topic}] does not appear to be published yet{self.instead(topic, self.topics())}"

    def without_events(self, service: str) -> str:
        """Return a message that a service publishes no introspection events, with the remedy or a suggestion."""
        if not self.endpoints(Kind.SERVICE, service):
            return f"no node offers the service {service}{self.instead(service, *self.offered())}"
        return (
            f"{service} publishes no events of its calls yet; its node must call configure_introspection('contents'), "
            "or give the service introspection='contents'"
        )

    def _types(self, *kinds: Kind, hidden: bool) -> dict[str, list[str]]:
        found: dict[str, set[str]] = {}
        for e in self:
            if e.kind in kinds and (hidden or not is_hidden(e.name)):
                found.setdefault(e.name, set()).add(e.type)
        return {name: sorted(found[name]) for name in sorted(found)}


def _of_type(name: str, type_name: str, types: Mapping[str, Sequence[str]], users: Iterable[str]) -> str:
    """Return the end of a message that a name is not offered: others of its type, or one that is hardly different.

    The nearest name of any type would mislead: a client of `Spawn` does not mean `/turtle1/set_pen`.

    Args:
        types: The types of all names that are offered.
        users: Those that are not of every node.
    """
    same = sorted(other for other in types if type_name in types[other])
    if like := nearest(name, same):
        return f"; did you mean {like!r}?"
    if same:
        more = f" and {len(same) - _SHOWN} more" if len(same) > _SHOWN else ""
        return f"; of that type there is {', '.join(same[:_SHOWN])}{more}"
    like = nearest(name, sorted(users), cutoff=_HARDLY_DIFFERENT)
    return f"; did you mean {like!r}, of type {' and '.join(types[like])}?" if like else ""
