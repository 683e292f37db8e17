"""Callbacks for changes of parameters anywhere in the graph."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.impl.reexports import passed_on
from rclpy.parameter_client import on_parameter_event
from rclpy.qos import QoSProfile, qos_profile_parameter_events

if TYPE_CHECKING:
    from rcl_interfaces.msg import Parameter as ParameterMessage
    from rcl_interfaces.msg import ParameterEvent

    from rclpy.callback_groups import CallbackGroup
    from rclpy.event_handler import SubscriptionEventCallbacks
    from rclpy.node import Node
    from rclpy.qos_overriding_options import QoSOverridingOptions


class ParameterCallbackHandle:
    """A callback for one parameter of one node."""

    def __init__(self, parameter_name: str, node_name: str, callback: Callable[[ParameterMessage], None]) -> None:
        self.parameter_name, self.node_name, self.callback = parameter_name, node_name, callback


class ParameterEventCallbackHandle:
    """A callback for all changes."""

    def __init__(self, callback: Callable[[ParameterEvent], None]) -> None:
        self.callback = callback


class _Callbacks:
    def __init__(self) -> None:
        self.parameter_callbacks: dict[tuple[str, str], list[ParameterCallbackHandle]] = {}
        self.event_callbacks: list[ParameterEventCallbackHandle] = []
        self.lock = threading.RLock()

    def event_callback(self, event: ParameterEvent) -> None:
        """Call the callbacks that an event concerns, newest first."""
        with self.lock:
            for (parameter_name, node_name), handles in list(self.parameter_callbacks.items()):
                parameter = ParameterEventHandler.get_parameter_from_event(event, parameter_name, node_name)
                if parameter is not None:
                    for handle in list(handles):
                        handle.callback(parameter)
            # A copy, and a reentrant lock: a callback may remove itself.
            for event_handle in list(self.event_callbacks):
                event_handle.callback(event)


class ParameterEventHandler:
    """Calls back when parameters change, of this node or of others."""

    def __init__(
        self,
        node: Node,
        qos_profile: QoSProfile = qos_profile_parameter_events,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> None:
        self.node, self.qos_profile = node, qos_profile
        self._callbacks = _Callbacks()
        self.parameter_event_subscription = on_parameter_event(
            node,
            self._callbacks.event_callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )

    def destroy(self) -> None:
        """Stop calling back."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    @staticmethod
    def get_parameter_from_event(event: ParameterEvent, parameter_name: str, node_name: str) -> ParameterMessage | None:
        """Return an event's message of a new or changed parameter; None if it has none."""
        if event.node != node_name:
            return None
        found = (p for p in ParameterEventHandler.get_parameters_from_event(event) if p.name == parameter_name)
        return next(found, None)

    @staticmethod
    def get_parameters_from_event(event: ParameterEvent) -> list[ParameterMessage]:
        """Return an event's messages of all new or changed parameters."""
        return [*event.new_parameters, *event.changed_parameters]

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[ParameterMessage], None]
    ) -> ParameterCallbackHandle:
        """Call `callback(message)` when a parameter of a node is set."""
        full = self._resolve_path(node_name)
        handle = ParameterCallbackHandle(parameter_name, full, callback)
        with self._callbacks.lock:
            self._callbacks.parameter_callbacks.setdefault((parameter_name, full), []).insert(0, handle)
        return handle

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Remove such a callback. Raises RuntimeError if it was not added."""
        key = (handle.parameter_name, handle.node_name)
        with self._callbacks.lock:
            handles = self._callbacks.parameter_callbacks.get(key, [])
            if handle not in handles:
                raise RuntimeError("Callback doesn't exist")
            handles.remove(handle)
            if not handles:
                del self._callbacks.parameter_callbacks[key]

    def add_parameter_event_callback(self, callback: Callable[[ParameterEvent], None]) -> ParameterEventCallbackHandle:
        """Call `callback(event)` for every change."""
        handle = ParameterEventCallbackHandle(callback)
        with self._callbacks.lock:
            self._callbacks.event_callbacks.insert(0, handle)
        return handle

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Remove such a callback. Raises RuntimeError if it was not added."""
        with self._callbacks.lock:
            if handle not in self._callbacks.event_callbacks:
                raise RuntimeError("Callback doesn't exist")
            self._callbacks.event_callbacks.remove(handle)

    def _resolve_path(self, node_path: str | None = None) -> str:
        """Return the full name of a node, by default of this one."""
        if not node_path:
            return str(self.node.get_fully_qualified_name())
        if node_path.startswith("/"):
            return node_path
        namespace = self.node.get_namespace().strip("/")
        return "/" + "/".join(part for part in (namespace, node_path) if part)


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)
