"""Access to the parameters of other nodes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from graphflow.rclpy.wake import Wake
from rclpy.impl.reexports import passed_on
from rclpy.parameter import Parameter, parameter_dict_from_yaml_file
from rclpy.qos import QoSProfile, qos_profile_parameter_events, qos_profile_services_default
from rclpy.task import Future

if TYPE_CHECKING:
    from rcl_interfaces.msg import Parameter as ParameterMessage

    from rclpy.callback_groups import CallbackGroup
    from rclpy.client import Client
    from rclpy.event_handler import SubscriptionEventCallbacks
    from rclpy.node import Node
    from rclpy.qos_overriding_options import QoSOverridingOptions
    from rclpy.subscription import Subscription

Callback = Callable[..., object] | None


class AsyncParameterClient:
    """A client of a node's parameter services; each call returns a future of the service's response.

    Args:
        remote_node_name: The node's name, absolute or relative to this node's namespace.
    """

    def __init__(
        self,
        node: Node,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        from rcl_interfaces import srv

        self.remote_node_name, self.node = remote_node_name, node

        def client(type_: type, name: str) -> Client:
            options: dict[str, Any] = {"qos_profile": qos_profile, "callback_group": callback_group}
            return node.create_client(type_, f"{remote_node_name}/{name}", **options)

        self._get = client(srv.GetParameters, "get_parameters")
        self._list = client(srv.ListParameters, "list_parameters")
        self._set = client(srv.SetParameters, "set_parameters")
        self._types = client(srv.GetParameterTypes, "get_parameter_types")
        self._describe = client(srv.DescribeParameters, "describe_parameters")
        self._set_all = client(srv.SetParametersAtomically, "set_parameters_atomically")
        self._clients = (self._get, self._list, self._set, self._types, self._describe, self._set_all)

    def services_are_ready(self) -> bool:
        """Whether the node is available, with all its parameter services."""
        return all(client.service_is_ready() for client in self._clients)

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Block until the services are available, at most `timeout_sec` seconds; return whether they are."""
        life, wake = self.node.context.life, Wake()
        assert life is not None  # a node has joined it
        life.on_end(wake)
        for client in self._clients:
            client.server_wakes[wake] = None
        try:
            limit = None if timeout_sec is None or timeout_sec < 0 else timeout_sec
            wake.wait_until(lambda: not life.is_ok or self.services_are_ready(), limit)
        finally:
            life.forget(wake)
            for client in self._clients:
                client.server_wakes.pop(wake, None)
        return self.services_are_ready()

    @staticmethod
    def _call(client: Client, request: object, callback: Callback) -> Future:
        future = client.call_async(request)
        if callback is not None:
            future.add_done_callback(callback)
        return future

    def list_parameters(
        self, prefixes: list[str] | None = None, depth: int | None = None, callback: Callback = None
    ) -> Future:
        """List the names below prefixes, at most `depth` levels."""
        request = self._list.srv_type.Request(prefixes=prefixes or [], depth=depth or 0)
        return self._call(self._list, request, callback)

    def get_parameters(self, names: list[str], callback: Callback = None) -> Future:
        return self._call(self._get, self._get.srv_type.Request(names=names), callback)

    def set_parameters(self, parameters: Sequence[Parameter | ParameterMessage], callback: Callback = None) -> Future:
        """Set parameters, given as `Parameter`s or as messages, one after the other."""
        return self._call(self._set, self._set.srv_type.Request(parameters=_messages(parameters)), callback)

    def describe_parameters(self, names: list[str], callback: Callback = None) -> Future:
        return self._call(self._describe, self._describe.srv_type.Request(names=names), callback)

    def get_parameter_types(self, names: list[str], callback: Callback = None) -> Future:
        return self._call(self._types, self._types.srv_type.Request(names=names), callback)

    def set_parameters_atomically(
        self, parameters: Sequence[Parameter | ParameterMessage], callback: Callback = None
    ) -> Future:
        """Set all parameters or none."""
        return self._call(self._set_all, self._set_all.srv_type.Request(parameters=_messages(parameters)), callback)

    def delete_parameters(self, names: list[str], callback: Callback = None) -> Future:
        """Delete parameters; only those with dynamic typing can be deleted."""
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(self, parameter_file: str, use_wildcard: bool = False, callback: Callback = None) -> Future:
        """Set a file's parameters for the node. Errors as for `parameter_dict_from_yaml_file`."""
        return self.set_parameters(self._of_file(parameter_file, use_wildcard), callback)

    def load_parameter_file_atomically(
        self, parameter_file: str, use_wildcard: bool = False, callback: Callback = None
    ) -> Future:
        """Set all of a file's parameters for the node, or none."""
        return self.set_parameters_atomically(self._of_file(parameter_file, use_wildcard), callback)

    def _of_file(self, file: str, use_wildcard: bool) -> list[ParameterMessage]:
        return list(parameter_dict_from_yaml_file(file, use_wildcard).values())

    def on_parameter_event(
        self,
        callback: Callable[..., object],
        qos_profile: QoSProfile = qos_profile_parameter_events,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription:
        """Call `callback` with each change of parameters in the graph."""
        return on_parameter_event(
            self.node,
            callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )


def on_parameter_event(
    node: Node, callback: Callable[..., object], qos_profile: QoSProfile, **options: Any
) -> Subscription:
    """Subscribe to /parameter_events."""
    from rcl_interfaces.msg import ParameterEvent

    return node.create_subscription(ParameterEvent, "/parameter_events", callback, qos_profile, **options)


def _messages(parameters: Sequence[Parameter | ParameterMessage]) -> list[ParameterMessage]:
    return [p.to_parameter_msg() if isinstance(p, Parameter) else p for p in parameters]


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)
