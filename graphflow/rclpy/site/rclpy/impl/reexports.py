"""Names that rclpy's modules merely import, and that programs import from there.

Source: the import statements of rclpy's modules, as of Jazzy.
"""

from __future__ import annotations

from importlib import import_module

_EXCEPTIONS = (
    *("InvalidHandle", "InvalidParameterTypeException", "InvalidParameterValueException", "InvalidTopicNameException"),
    *("ParameterAlreadyDeclaredException", "ParameterImmutableException", "ParameterNotDeclaredException"),
    "ParameterUninitializedException",
)
_MESSAGES = (
    *("FloatingPointRange", "IntegerRange", "ListParametersResult", "ParameterDescriptor", "ParameterEvent"),
    *("ParameterType", "ParameterValue", "SetParametersResult"),
)
_GROUP = {"rclpy.callback_groups": ("CallbackGroup",)}
_QOS = {"rclpy.qos": ("QoSProfile",)}
_EVENTS = {"rclpy.event_handler": ("PublisherEventCallbacks", "SubscriptionEventCallbacks")}
_SERVICE = {
    "rclpy.service_introspection": ("ServiceIntrospectionState",),
    "rclpy.type_support": ("SrvType", "SrvTypeRequest", "SrvTypeResponse"),
}
_MESSAGE = {"rclpy.event_handler": ("EventHandler", "PublisherEventCallbacks", "SubscriptionEventCallbacks")}
_MESSAGE_TYPE = {"rclpy.type_support": ("MsgType",)}
_TYPES = ("MsgType", "SrvType", "SrvTypeRequest", "SrvTypeResponse")
_NODE: dict[str, tuple[str, ...]] = {"rclpy.node": ("Node",)}
PASSED: dict[str, dict[str, tuple[str, ...]]] = {
    "action.client": {
        "action_msgs.msg": ("GoalStatus",),
        "action_msgs.srv": ("CancelGoal",),
        "unique_identifier_msgs.msg": ("UUID",),
    },
    "action.server": {"action_msgs.msg": ("GoalInfo", "GoalStatus"), "rclpy._rclpy_pybind11": ("RCLError",)},
    "client": {"rclpy.clock": ("Clock",), "rclpy.context": ("Context",), **_SERVICE, **_GROUP, **_QOS},
    "event_handler": {"rclpy.logging": ("get_logger",), "rclpy.waitable": ("NumberOfEntities",), **_GROUP},
    "executors": {
        "concurrent.futures": ("ThreadPoolExecutor",),
        "rclpy.client": ("Client",),
        "rclpy.clock": ("Clock", "ClockType"),
        "rclpy.context": ("Context",),
        "rclpy.exceptions": ("InvalidHandle",),
        "rclpy.guard_condition": ("GuardCondition",),
        "rclpy.service": ("Service",),
        "rclpy.subscription": ("Subscription",),
        "rclpy.timer": ("Timer", "TimerInfo"),
        "rclpy.utilities": ("timeout_sec_to_nsec",),
        "rclpy.waitable": ("NumberOfEntities", "Waitable"),
    },
    "guard_condition": {"rclpy.context": ("Context",), "rclpy.utilities": ("get_default_context",)},
    "lifecycle.node": {"rclpy.service": ("Service",), **_GROUP, **_QOS},
    "lifecycle.publisher": {**_GROUP, **_QOS, **_EVENTS},
    "logging_service": {"rcl_interfaces.msg": ("LoggerLevel", "SetLoggerLevelsResult")},
    "node": {
        "rcl_interfaces.msg": _MESSAGES,
        "rcl_interfaces.srv": ("ListParameters",),
        "rclpy.callback_groups": ("MutuallyExclusiveCallbackGroup", "ReentrantCallbackGroup"),
        "rclpy.clock": ("ROSClock",),
        "rclpy.exceptions": _EXCEPTIONS,
        "rclpy.expand_topic_name": ("expand_topic_name",),
        "rclpy.logging": ("get_logger",),
        "rclpy.parameter": ("PARAMETER_SEPARATOR_STRING",),
        "rclpy.qos": ("qos_profile_parameter_events",),
        "rclpy.time_source": ("TimeSource",),
        "rclpy.timer": ("TimerInfo",),
        "rclpy.topic_endpoint_info": ("TopicEndpointInfo",),
        "rclpy.type_support": ("check_is_valid_msg_type", "check_is_valid_srv_type", *_TYPES),
        "rclpy.validate_full_topic_name": ("validate_full_topic_name",),
        "rclpy.validate_namespace": ("validate_namespace",),
        "rclpy.validate_node_name": ("validate_node_name",),
        "rclpy.validate_parameter_name": ("validate_parameter_name",),
        "rclpy.validate_topic_name": ("validate_topic_name",),
        "rclpy.waitable": ("Waitable",),
    },
    "parameter": {"rcl_interfaces.msg": ("ParameterType", "ParameterValue")},
    "parameter_client": {
        "rcl_interfaces.msg": ("ParameterEvent",),
        "rcl_interfaces.srv": (
            *("DescribeParameters", "GetParameterTypes", "GetParameters", "ListParameters", "SetParameters"),
            "SetParametersAtomically",
        ),
        **_NODE,
        **_GROUP,
    },
    "parameter_event_handler": {
        "rcl_interfaces.msg": ("ParameterEvent",),
        "rclpy.parameter": ("Parameter",),
        **_NODE,
        **_GROUP,
    },
    "publisher": {**_GROUP, **_QOS, **_MESSAGE, **_MESSAGE_TYPE},
    "qos_overriding_options": {"rcl_interfaces.msg": ("ParameterDescriptor", "SetParametersResult")},
    "service": {"rclpy.clock": ("Clock",), **_SERVICE, **_GROUP, **_QOS},
    "subscription": {**_GROUP, **_QOS, **_MESSAGE, **_MESSAGE_TYPE},
    "time_source": {"rcl_interfaces.msg": ("SetParametersResult",)},
    "timer": {"rclpy.clock": ("ClockType",), "rclpy.context": ("Context",)},
    "wait_for_message": _NODE,
}
"""The names that each module re-exports, by their original modules."""
_RENAMED = {("node", "ParameterMsg"), ("parameter", "ParameterMsg"), ("parameter_client", "ParameterMsg")}


def passed_on(module: str, name: str) -> object:
    """Return a re-exported name of a module. Raises AttributeError if it has none of that name."""
    key = module.removeprefix("rclpy.")
    if (key, name) in _RENAMED:
        return import_module("rcl_interfaces.msg").Parameter
    for source, names in PASSED[key].items():
        if name in names:
            return getattr(import_module(source), name)
    raise AttributeError(f"module {module!r} has no attribute {name!r}")
