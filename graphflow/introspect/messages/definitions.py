"""Types nobody installed here: their definitions, asked of the nodes that use them.

Source: type_description_interfaces/srv/GetTypeDescription (REP-2016).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graphflow.errors import GraphflowError, InterfaceError, UnknownInterface, printable
from graphflow.introspect.graph_view import View
from graphflow.machines.cache import GraphCache
from graphflow.msgs import registry
from graphflow.wire.described import DESCRIBING, FieldSaid, definition_of, verified
from graphflow.wire.liveliness import Entity, Kind

if TYPE_CHECKING:
    from graphflow.runtime.node import Node

LIMIT = 2.0
"""Seconds that a node has to answer."""
SAID = 300
"""Characters of a node's reason that are told."""
ASKED = 3
"""Nodes that are asked, one after the other."""
NOBODY = "no node that uses it gives its definition"


def request_for(entity: Entity) -> Any:
    """What to ask of the node of an endpoint."""
    request = registry.interface_class(f"{DESCRIBING}_Request")
    return request(type_name=entity.type, type_hash=entity.hash, include_type_sources=True)


def service_of(entity: Entity) -> str:
    """The service to ask."""
    return f"{entity.node_name}/get_type_description"


def sources_in(response: Any, entity: Entity) -> dict[str, str]:
    """The texts of a type and of all types in it, from a node's answer: its files if it sent them, else made of what
    it describes.

    Raises:
        InterfaceError: The node has refused, or what it sent is wrong, too large, or has not the hash it announced.
    """
    if not response.successful:
        raise InterfaceError(f"{entity.node_name}: {printable(response.failure_reason[:SAID])}")
    files = {s.type_name: s.raw_file_contents for s in response.type_sources if s.encoding in ("msg", "srv", "action")}
    described = response.type_description
    parts = [described.type_description, *described.referenced_type_descriptions]
    try:
        needed = verified(entity.type, entity.hash, files)
    except InterfaceError:
        if not described.type_description.type_name:
            raise
        # Its files are in IDL, or there are none.
        files = {part.type_name: definition_of(part.type_name, [_said(f) for f in part.fields]) for part in parts}
        needed = verified(entity.type, entity.hash, files)
    return {name: files[name] for name in needed}


def _said(field: Any) -> FieldSaid:
    kind = field.type
    return FieldSaid(field.name, kind.type_id, kind.capacity, kind.string_capacity, kind.nested_type_name)


def endpoints_of(cache: GraphCache, name: str, kinds: tuple[Kind, ...]) -> list[Entity]:
    """The endpoints on a name whose nodes can be asked."""
    servers = {e.node_name for e in cache.endpoints(Kind.SERVICE) if e.name.endswith("/get_type_description")}
    return [e for kind in kinds for e in cache.endpoints(kind, name) if e.node_name in servers]


async def asked_sources(node: Node, entity: Entity) -> dict[str, str]:
    """The texts of the type of an endpoint and of all types in it, asked of the nodes on its name.

    Raises:
        InterfaceError: Nobody gives a definition that has the hash.
    """
    reasons = []
    users = endpoints_of(node.context.cache, entity.name, (entity.kind,))
    for user in [u for u in users if (u.type, u.hash) == (entity.type, entity.hash)][:ASKED]:
        client: Any = node.create_client(registry.interface_class(DESCRIBING), service_of(user))
        try:
            return sources_in(await client.call(request_for(user), timeout=LIMIT), user)
        except GraphflowError as error:
            reasons.append(str(error))
        finally:
            client.close()
    raise InterfaceError("; ".join(reasons) or NOBODY)


def learn(view: View, name: str, type_name: str, kinds: tuple[Kind, ...] = (Kind.PUBLISHER, Kind.SUBSCRIPTION)) -> None:
    """Make the type of a name known here; nothing is asked if it is.

    Args:
        name: A topic, or for other kinds a service.
        type_name: Its type, `package/kind/Name`.

    Raises:
        UnknownInterface: It is not known here, and no node gives a definition that can be used.
    """
    try:
        registry.full_name(type_name)
    except UnknownInterface as unknown:
        if "/action/" in type_name:
            package, _, base = type_name.split("/")
            where = f"interfaces/{package}/action/{base.partition('_')[0]}.action"
            raise UnknownInterface(f"{unknown}; nodes are not asked for actions: put its file into {where}") from None
        reasons = []
        users: dict[str, Entity] = {}
        for entity in endpoints_of(view.cache, name, kinds):
            if entity.type == type_name:
                users.setdefault(entity.node_name, entity)
        for entity in list(users.values())[:ASKED]:
            try:
                response = view.call(service_of(entity), DESCRIBING, request_for(entity), LIMIT)
                registry.adopt(type_name, entity.hash, sources_in(response, entity))
            except GraphflowError as error:
                reasons.append(str(error))
            else:
                return
        why = "; ".join(reasons) or NOBODY
        raise UnknownInterface(f"{unknown}; {why}") from None
