"""QoS policies that a node's parameters may override."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from rcl_interfaces.msg import SetParametersResult as QosCallbackResult

from rclpy.duration import Duration
from rclpy.exceptions import ParameterAlreadyDeclaredException
from rclpy.impl.reexports import passed_on
from rclpy.parameter import Parameter
from rclpy.qos import QoSPolicyEnum, QoSPolicyKind, QoSProfile

if TYPE_CHECKING:
    from rcl_interfaces.msg import SetParametersResult

    from rclpy.node import Node


QosCallbackType = Callable[[QoSProfile], object]


class InvalidQosOverridesError(Exception):
    """The callback has rejected the profile."""


class QoSOverridingOptions:
    """The policies that parameters may override.

    Args:
        callback: Called with the resulting profile, which it may reject.
        entity_id: Distinguishes endpoints of one topic.
    """

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: Callable[[QoSProfile], QosCallbackResult] | None = None,
        entity_id: str | None = None,
    ) -> None:
        self._policy_kinds, self._callback, self._entity_id = policy_kinds, callback, entity_id

    @property
    def policy_kinds(self) -> Iterable[QoSPolicyKind]:
        return self._policy_kinds

    @property
    def callback(self) -> Callable[[QoSProfile], SetParametersResult] | None:
        return self._callback

    @property
    def entity_id(self) -> str | None:
        return self._entity_id

    @classmethod
    def with_default_policies(
        cls, *, callback: Callable[[QoSProfile], SetParametersResult] | None = None, entity_id: str | None = None
    ) -> QoSOverridingOptions:
        """Return the options for history, depth and reliability."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback=callback, entity_id=entity_id)


_FOR_SUBSCRIPTIONS = {
    *(QoSPolicyKind.DEADLINE, QoSPolicyKind.DEPTH, QoSPolicyKind.DURABILITY, QoSPolicyKind.HISTORY),
    *(QoSPolicyKind.LIVELINESS, QoSPolicyKind.LIVELINESS_LEASE_DURATION, QoSPolicyKind.RELIABILITY),
}
_ALLOWED = {"publisher": _FOR_SUBSCRIPTIONS | {QoSPolicyKind.LIFESPAN}, "subscription": _FOR_SUBSCRIPTIONS}


def _declare_qos_parameters(
    entity_type: type, node: Node, topic_name: str, qos: QoSProfile, options: QoSOverridingOptions
) -> None:
    """Declare the parameters that override policies of `qos`, and change it accordingly.

    Args:
        entity_type: `Publisher` or `Subscription`.

    Raises:
        InvalidQosOverridesError: The callback has rejected the result.
    """
    from rcl_interfaces.msg import ParameterDescriptor

    entity = entity_type.__name__.lower()
    suffix = f"_{options.entity_id}" if options.entity_id else ""
    for policy in options.policy_kinds:
        if policy not in _ALLOWED[entity]:
            continue
        short = policy.name.lower()
        name = f"qos_overrides.{topic_name}.{entity}{suffix}.{short}"
        descriptor = ParameterDescriptor(read_only=True, description=f"{short} of the {entity} of {topic_name}")
        try:
            parameter = node.declare_parameter(name, _get_qos_policy_parameter(qos, policy), descriptor)
        except ParameterAlreadyDeclaredException:  # by another endpoint of that topic
            parameter = node.get_parameter(name)
        _override(qos, short, parameter)
    if options.callback is not None:
        result = options.callback(qos)
        if not result.successful:
            raise InvalidQosOverridesError(
                f"{result.reason}\n for qos parameters of {entity} {topic_name}{suffix and f' ({options.entity_id})'}"
            )


def _get_qos_policy_parameter(qos: QoSProfile, policy: QoSPolicyKind) -> object:
    """Return a policy as the value of a parameter."""
    value = getattr(qos, policy.name.lower())
    if isinstance(value, QoSPolicyEnum):
        return value.name.lower()
    return value.nanoseconds if isinstance(value, Duration) else value


def _override(qos: QoSProfile, policy: str, parameter: Parameter) -> None:
    former = getattr(qos, policy)
    value = parameter.value
    if isinstance(former, QoSPolicyEnum):
        value = type(former).get_from_short_key(value)
    elif isinstance(former, Duration):
        value = Duration(nanoseconds=value)
    setattr(qos, policy, value)


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)
