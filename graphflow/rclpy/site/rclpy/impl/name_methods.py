"""The part of a node that has names and resolves others."""

from __future__ import annotations

from typing import Any

from rclpy.expand_topic_name import expand_topic_name
from rclpy.handle import Handle
from rclpy.impl.internals import Internals
from rclpy.type_support import check_is_valid_msg_type, check_is_valid_srv_type
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_topic_name import validate_topic_name


class NameMethods:
    """The node's methods for names; a base class of `Node`."""

    _graphflow: Internals
    _graphflow_handle_of_node: Handle

    def get_name(self) -> str:
        with self._graphflow_handle_of_node:
            return self._graphflow.node.name

    def get_namespace(self) -> str:
        with self._graphflow_handle_of_node:
            return self._graphflow.node.namespace

    def get_fully_qualified_name(self) -> str:
        with self._graphflow_handle_of_node:
            return self._graphflow.node.full_name

    def _graphflow_resolved(self, name: str, kind: Any = "topic", *, only_expand: bool = False) -> str:
        inner = self._graphflow
        full = expand_topic_name(name, inner.node.name, inner.node.namespace)
        validate_full_topic_name(full, is_service=kind == "service")
        return full if only_expand else inner.core.names.resolve(full, kind)

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name of a topic, remapped unless `only_expand`."""
        with self._graphflow_handle_of_node:
            return self._graphflow_resolved(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service, remapped unless `only_expand`."""
        with self._graphflow_handle_of_node:
            return self._graphflow_resolved(service, "service", only_expand=only_expand)

    def _graphflow_topic(self, msg_type: Any, topic: str) -> str:
        check_is_valid_msg_type(msg_type)
        validate_topic_name(topic)
        return self._graphflow_resolved(topic)

    def _graphflow_service(self, srv_type: object, srv_name: str) -> str:
        check_is_valid_srv_type(srv_type)
        validate_topic_name(srv_name, is_service=True)
        return self._graphflow_resolved(srv_name, "service")
