"""The part of a node that reads the graph."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from graphflow.machines.cache import GraphCache
from graphflow.rclpy.context_state import LOOP
from graphflow.wire.liveliness import Kind
from rclpy._rclpy_pybind11 import NodeNameNonExistentError
from rclpy.exceptions import InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.handle import Handle
from rclpy.impl.internals import Internals
from rclpy.qos import from_graphflow
from rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from rclpy.type_hash import TypeHash
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name


class GraphMethods:
    """The node's methods for the graph; a base class of `Node`."""

    _graphflow: Internals
    _graphflow_handle_of_node: Handle

    def _graphflow_graph(self, query: Callable[[GraphCache], object]) -> Any:
        with self._graphflow_handle_of_node:
            return LOOP.call(query, self._graphflow.core.context.cache)

    def _graphflow_of_node(self, node_name: str, node_namespace: str, kind: Kind) -> list[tuple[str, list[str]]]:
        full = f"{node_namespace.rstrip('/')}/{node_name}"
        _refuse_names(node_name, node_namespace)

        def query(cache: GraphCache) -> list[tuple[str, list[str]]] | None:
            if not cache.owners(full):
                return None
            found: dict[str, set[str]] = {}
            for entity in cache.endpoints(kind, node=full):
                found.setdefault(entity.name, set()).add(entity.type)
            return [(name, sorted(types)) for name, types in sorted(found.items())]

        rows = self._graphflow_graph(query)
        if rows is None:
            raise NodeNameNonExistentError(f"Cannot get information about node {full}: it does not exist")
        found: list[tuple[str, list[str]]] = rows
        return found

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> list[tuple[str, list[str]]]:
        """Return the topics that a node publishes, with their types. Raises NodeNameNonExistentError."""
        return self._graphflow_of_node(node_name, node_namespace, Kind.PUBLISHER)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> list[tuple[str, list[str]]]:
        return self._graphflow_of_node(node_name, node_namespace, Kind.SUBSCRIPTION)

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> list[tuple[str, list[str]]]:
        return self._graphflow_of_node(node_name, node_namespace, Kind.SERVICE)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> list[tuple[str, list[str]]]:
        return self._graphflow_of_node(node_name, node_namespace, Kind.CLIENT)

    def get_topic_names_and_types(self, no_demangle: bool = False) -> list[tuple[str, list[str]]]:
        """Return all topics with their types."""
        rows: dict[str, list[str]] = self._graphflow_graph(lambda cache: cache.topics(hidden=True))
        return list(rows.items())

    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Return all services with their types."""
        rows: dict[str, list[str]] = self._graphflow_graph(lambda cache: cache.services(hidden=True))
        return list(rows.items())

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return all nodes."""
        names: list[str] = self._graphflow_graph(lambda cache: cache.nodes())
        return [(name.rpartition("/")[2], name.rpartition("/")[0] or "/") for name in names]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        return [(name, namespace, "/") for name, namespace in self.get_node_names_and_namespaces()]

    def get_node_names(self) -> list[str]:
        return [name for name, _ in self.get_node_names_and_namespaces()]

    def get_fully_qualified_node_names(self) -> list[str]:
        found: list[str] = self._graphflow_graph(lambda cache: cache.nodes())
        return found

    def _graphflow_count(self, name: str, kind: Kind, of: Any) -> int:
        if not isinstance(name, str):
            raise TypeError(f"a name is a str, not {type(name)}")
        inner = self._graphflow
        full = expand_topic_name(name, inner.node.name, inner.node.namespace)
        full = inner.core.names.resolve(full, of)
        return int(self._graphflow_graph(lambda cache: len(cache.endpoints(kind, full))))

    def count_publishers(self, topic_name: str) -> int:
        return self._graphflow_count(topic_name, Kind.PUBLISHER, "topic")

    def count_subscribers(self, topic_name: str) -> int:
        return self._graphflow_count(topic_name, Kind.SUBSCRIPTION, "topic")

    def count_clients(self, service_name: str) -> int:
        return self._graphflow_count(service_name, Kind.CLIENT, "service")

    def count_services(self, service_name: str) -> int:
        return self._graphflow_count(service_name, Kind.SERVICE, "service")

    def _graphflow_info(self, topic_name: str, kind: Kind, no_mangle: bool) -> list[TopicEndpointInfo]:
        if not isinstance(topic_name, str):
            raise TypeError(f"a topic's name is a str, not {type(topic_name)}")
        full = topic_name if no_mangle else self._graphflow_expanded(topic_name)
        return [_endpoint_info(entity) for entity in self._graphflow_graph(lambda cache: cache.endpoints(kind, full))]

    def _graphflow_expanded(self, topic_name: str) -> str:
        inner = self._graphflow
        try:
            full = expand_topic_name(topic_name, inner.node.name, inner.node.namespace)
            validate_full_topic_name(full)
        except InvalidTopicNameException as error:
            raise ValueError(f"topic name is invalid: {error}") from None
        return inner.core.names.resolve(full)

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return information on a topic's publishers."""
        return self._graphflow_info(topic_name, Kind.PUBLISHER, no_mangle)

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return information on a topic's subscriptions."""
        return self._graphflow_info(topic_name, Kind.SUBSCRIPTION, no_mangle)

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Block until a node exists, at most `timeout` seconds; return whether it does."""
        if not fully_qualified_node_name.startswith("/"):
            fully_qualified_node_name = f"/{fully_qualified_node_name}"
        context = self._graphflow.core.context

        async def there() -> None:
            await context.wait_for(lambda: bool(context.cache.owners(fully_qualified_node_name)))

        try:
            LOOP.wait(there, timeout=timeout)
        except TimeoutError:
            return False
        return True


def _refuse_names(name: str, namespace: str) -> None:
    validate_node_name(name)
    validate_namespace(namespace)


def _endpoint_info(entity: Any) -> TopicEndpointInfo:
    kind = TopicEndpointTypeEnum.PUBLISHER if entity.kind is Kind.PUBLISHER else TopicEndpointTypeEnum.SUBSCRIPTION
    version, _, digest = entity.hash.partition("_")
    known = version.startswith("RIHS")
    return TopicEndpointInfo(
        node_name=entity.node_name.rpartition("/")[2],
        node_namespace=entity.node_name.rpartition("/")[0] or "/",
        topic_type=entity.type,
        topic_type_hash=TypeHash(int(version[4:]), bytes.fromhex(digest)) if known else TypeHash(),
        endpoint_type=kind,
        endpoint_gid=list(entity.gid),
        qos_profile=from_graphflow(entity.qos),
    )
