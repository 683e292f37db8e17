"""The common base of service clients and servers."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Self

from rclpy.handle import Handle
from rclpy.impl.mistakes.origins import Created
from rclpy.qos import to_graphflow

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from rclpy.clock import Clock
    from rclpy.qos import QoSProfile
    from rclpy.service_introspection import ServiceIntrospectionState


class ServiceEnd(Created):
    """A client or server of a service."""

    endpoint: Any
    _life: ContextState
    _handle: Handle

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Publish the service's calls on `<service>/_service_event`: nothing, metadata, or contents too."""
        level, qos = introspection_state.name.lower(), to_graphflow(service_event_qos_profile)
        self._life.on_loop(partial(self.endpoint.configure_introspection, level, qos))

    @property
    def handle(self) -> Handle:
        return self._handle

    @property
    def service_name(self) -> str:
        """The full name of the service."""
        with self._handle:
            name: str = self.endpoint.name
            return name

    def destroy(self) -> None:
        """Withdraw the entity. Call `Node.destroy_client` or `Node.destroy_service` instead."""
        self._handle.destroy_when_not_in_use()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()
