"""Definitions of types that are not installed here, fetched from the nodes that use them.

Source: type_description_interfaces/srv/GetTypeDescription (REP-2016).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graphflow.errors import GraphflowError, InterfaceError, UnknownInterface, printable
from graphflow.introspect.graph_view import View
from graphflow.machines.cache import GraphCache
from graphflow.msgs import registry
from graphflow.wire.described import DESCRIBING, DescribedField, definition_of, verified
from graphflow.wire.liveliness import Entity, Kind

if TYPE_CHECKING:
    from graphflow.msgs.type_description_interfaces.msg import Field
    from graphflow.msgs.type_description_interfaces.srv import GetTypeDescription_Request, GetTypeDescription_Response
    from graphflow.runtime.node import Node

LIMIT = 2.0
"""Seconds that a node has to answer."""
REASON_BOUND = 300
"""Most characters of a node's reason that an error quotes."""
NODES_BOUND = 3
"""Most nodes that are queried for a definition."""
NOBODY = "no node that uses it provides its definition"


def request_for(entity: Entity) -> GetTypeDescription_Request:
    """Return the request for the definition of an endpoint's type."""
    request: type[GetTypeDescription_Request] = registry.interface_class(f"{DESCRIBING}_Request")
    return request(type_name=entity.type, type_hash=entity.hash, include_type_sources=True)


def service_of(entity: Entity) -> str:
    """Return the name of the service that describes an endpoint's type."""
    return f"{entity.node_name}/get_type_description"


def sources_in(response: GetTypeDescription_Response, entity: Entity) -> dict[str, str]:
    """Return the definitions of a type and its nested types from a node's answer: its files if sent, or else made from
    the description.

    Raises:
        InterfaceError: The node refused, or its answer is invalid, too large, or does not have the announced hash.
    """
    if not response.successful:
        raise InterfaceError(f"{entity.node_name}: {printable(response.failure_reason[:REASON_BOUND])}")
    files = {s.type_name: s.raw_file_contents for s in response.type_sources if s.encoding in ("msg", "srv", "action")}
    described = response.type_description
    parts = [described.type_description, *described.referenced_type_descriptions]
    try:
        needed = verified(entity.type, entity.hash, files)
    except InterfaceError:
        if not described.type_description.type_name:
            raise
        # Its files are in IDL, or it sent none.
        files = {part.type_name: definition_of(part.type_name, [_field_of(f) for f in part.fields]) for part in parts}
        needed = verified(entity.type, entity.hash, files)
    return {name: files[name] for name in needed}


def _field_of(field: Field) -> DescribedField:
    kind = field.type
    return DescribedField(field.name, kind.type_id, kind.capacity, kind.string_capacity, kind.nested_type_name)


def endpoints_of(cache: GraphCache, name: str, kinds: tuple[Kind, ...]) -> list[Entity]:
    """Return the endpoints on a name whose nodes can describe types."""
    servers = {e.node_name for e in cache.endpoints(Kind.SERVICE) if e.name.endswith("/get_type_description")}
    return [e for kind in kinds for e in cache.endpoints(kind, name) if e.node_name in servers]


async def asked_sources(node: Node, entity: Entity) -> dict[str, str]:
    """Fetch the definitions of an endpoint's type and its nested types from the nodes on its name.

    Raises:
        InterfaceError: No node provides a definition with the announced hash.
    """
    reasons = []
    users = endpoints_of(node.context.cache, entity.name, (entity.kind,))
    for user in [u for u in users if (u.type, u.hash) == (entity.type, entity.hash)][:NODES_BOUND]:
        client: Any = node.create_client(registry.interface_class(DESCRIBING), service_of(user))
        try:
            return sources_in(await client.call(request_for(user), timeout=LIMIT), user)
        except GraphflowError as error:
            reasons.append(str(error))
        finally:
            client.close()
    raise InterfaceError("; ".join(reasons) or NOBODY)


def learn(view: View, name: str, type_name: str, kinds: tuple[Kind, ...] = (Kind.PUBLISHER, Kind.SUBSCRIPTION)) -> None:
    """Register the type of a name, fetched from its nodes unless it is already known.

    Args:
        name: A topic, or for other kinds a service.
        type_name: Its type, `package/kind/Name`.

    Raises:
        UnknownInterface: It is not known here, and no node provides a usable definition.
    """
    try:
        registry.full_name(type_name)
    except UnknownInterface as unknown:
        if "/action/" in type_name:
            package, _, base = type_name.split("/")
            where = f"interfaces/{package}/action/{base.partition('_')[0]}.action"
            raise UnknownInterface(f"{unknown}; nodes cannot describe actions: put its file into {where}") from None
        reasons = []
        users: dict[str, Entity] = {}
        for entity in endpoints_of(view.cache, name, kinds):
            if entity.type == type_name:
                users.setdefault(entity.node_name, entity)
        for entity in list(users.values())[:NODES_BOUND]:
            try:
                response = view.call(service_of(entity), DESCRIBING, request_for(entity), LIMIT)
                registry.adopt(type_name, entity.hash, sources_in(response, entity))
            except GraphflowError as error:
                reasons.append(str(error))
            else:
                return
        why = "; ".join(reasons) or NOBODY
        raise UnknownInterface(f"{unknown}; {why}") from None
