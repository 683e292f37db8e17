"""ROS 2's concepts and wire protocol in one pip install, native to asyncio.

PYTEST_DONT_REWRITE: `graphflow rclpy enable` has each Python import this, before pytest could rewrite it.
"""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # type checkers treat the name as true; importing `typing` would take longer than this file
if TYPE_CHECKING:
    from graphflow.errors import (
        Abort,
        BagError,
        CallError,
        CallTimeout,
        ClosedError,
        DeadlockError,
        DeclarationError,
        DecodeError,
        EncodeError,
        ExtrapolationError,
        FrameLoop,
        GoalAborted,
        GoalCanceled,
        GoalError,
        GoalLost,
        GoalRejected,
        GraphFileError,
        GraphflowError,
        InterfaceError,
        InvalidName,
        LoopBlockedError,
        MapFileError,
        NoCamera,
        ParameterError,
        RemoteError,
        ServerBusy,
        ServerInactive,
        ServerLost,
        ServiceUnavailable,
        SupervisorError,
        TooManyErrors,
        TransformError,
        TransitionFailed,
        TransitionRefused,
        TransportError,
        UnconnectedFrames,
        UnknownFrame,
        UnknownInterface,
        WrongThread,
    )
    from graphflow.executor.clock import Clock
    from graphflow.executor.groups import HandlerGroup
    from graphflow.machines.goal import GoalStatus
    from graphflow.machines.lifecycle import LifecycleState
    from graphflow.msgs.base import ServerGoalHandle
    from graphflow.qos import (
        Durability,
        History,
        Liveliness,
        Qos,
        Reliability,
    )
    from graphflow.runtime.actions.client import GoalClient
    from graphflow.runtime.actions.goal_handles import ClientGoalHandle
    from graphflow.runtime.actions.server import ActionServer
    from graphflow.runtime.context import Context
    from graphflow.runtime.declarations.declare import (
        ActionClient,
        Client,
        Group,
        Param,
        Publisher,
        Subscription,
    )
    from graphflow.runtime.declarations.handlers import (
        action,
        service,
        subscription,
        task,
        timer,
    )
    from graphflow.runtime.endpoints.events import QosEvent
    from graphflow.runtime.endpoints.publishers import TopicPublisher
    from graphflow.runtime.endpoints.service_client import ServiceClient
    from graphflow.runtime.endpoints.services import ServiceServer
    from graphflow.runtime.endpoints.subscriptions import TopicSubscription
    from graphflow.runtime.endpoints.timer import Timer, TimerInfo
    from graphflow.runtime.failures import ErrorBudget
    from graphflow.runtime.managed.lifecycle_node import LifecycleNode
    from graphflow.runtime.node import Node
    from graphflow.runtime.run import run, running
    from graphflow.times import Duration, Time
    from graphflow.wire.attachment import MessageInfo

__version__ = "0.1.0.dev0"

# Imported when first used: `graphflow --help` must not wait for zenoh and asyncio.
_HOMES = {
    "graphflow.errors": (
        "Abort",
        "BagError",
        "CallError",
        "CallTimeout",
        "ClosedError",
        "DeadlockError",
        "DeclarationError",
        "DecodeError",
        "EncodeError",
        "ExtrapolationError",
        "FrameLoop",
        "GoalAborted",
        "GoalCanceled",
        "GoalError",
        "GoalLost",
        "GoalRejected",
        "GraphFileError",
        "GraphflowError",
        "InterfaceError",
        "InvalidName",
        "LoopBlockedError",
        "MapFileError",
        "NoCamera",
        "ParameterError",
        "RemoteError",
        "ServerBusy",
        "ServerInactive",
        "ServerLost",
        "ServiceUnavailable",
        "SupervisorError",
        "TooManyErrors",
        "TransformError",
        "TransitionFailed",
        "TransitionRefused",
        "TransportError",
        "UnconnectedFrames",
        "UnknownFrame",
        "UnknownInterface",
        "WrongThread",
    ),
    "graphflow.executor.clock": ("Clock",),
    "graphflow.executor.groups": ("HandlerGroup",),
    "graphflow.machines.goal": ("GoalStatus",),
    "graphflow.machines.lifecycle": ("LifecycleState",),
    "graphflow.msgs.base": ("ServerGoalHandle",),
    "graphflow.qos": (
        "Durability",
        "History",
        "Liveliness",
        "Qos",
        "Reliability",
    ),
    "graphflow.runtime.actions.client": ("GoalClient",),
    "graphflow.runtime.actions.goal_handles": ("ClientGoalHandle",),
    "graphflow.runtime.actions.server": ("ActionServer",),
    "graphflow.runtime.context": ("Context",),
    "graphflow.runtime.declarations.declare": (
        "ActionClient",
        "Client",
        "Group",
        "Param",
        "Publisher",
        "Subscription",
    ),
    "graphflow.runtime.endpoints.events": ("QosEvent",),
    "graphflow.runtime.failures": ("ErrorBudget",),
    "graphflow.runtime.declarations.handlers": (
        "action",
        "service",
        "subscription",
        "task",
        "timer",
    ),
    "graphflow.runtime.managed.lifecycle_node": ("LifecycleNode",),
    "graphflow.runtime.node": ("Node",),
    "graphflow.runtime.endpoints.publishers": ("TopicPublisher",),
    "graphflow.runtime.run": (
        "run",
        "running",
    ),
    "graphflow.runtime.endpoints.service_client": ("ServiceClient",),
    "graphflow.runtime.endpoints.services": ("ServiceServer",),
    "graphflow.runtime.endpoints.timer": (
        "Timer",
        "TimerInfo",
    ),
    "graphflow.runtime.endpoints.subscriptions": ("TopicSubscription",),
    "graphflow.times": (
        "Duration",
        "Time",
    ),
    "graphflow.wire.attachment": ("MessageInfo",),
}

__all__ = [
    "Abort",
    "ActionClient",
    "ActionServer",
    "BagError",
    "CallError",
    "CallTimeout",
    "Client",
    "ClientGoalHandle",
    "Clock",
    "ClosedError",
    "Context",
    "DeadlockError",
    "DeclarationError",
    "DecodeError",
    "Durability",
    "Duration",
    "EncodeError",
    "ErrorBudget",
    "ExtrapolationError",
    "FrameLoop",
    "GoalAborted",
    "GoalCanceled",
    "GoalClient",
    "GoalError",
    "GoalLost",
    "GoalRejected",
    "GoalStatus",
    "GraphFileError",
    "GraphflowError",
    "Group",
    "HandlerGroup",
    "History",
    "InterfaceError",
    "InvalidName",
    "LifecycleNode",
    "LifecycleState",
    "Liveliness",
    "LoopBlockedError",
    "MapFileError",
    "MessageInfo",
    "NoCamera",
    "Node",
    "Param",
    "ParameterError",
    "Publisher",
    "Qos",
    "QosEvent",
    "Reliability",
    "RemoteError",
    "ServerBusy",
    "ServerGoalHandle",
    "ServerInactive",
    "ServerLost",
    "ServiceClient",
    "ServiceServer",
    "ServiceUnavailable",
    "Subscription",
    "SupervisorError",
    "Time",
    "Timer",
    "TimerInfo",
    "TooManyErrors",
    "TopicPublisher",
    "TopicSubscription",
    "TransformError",
    "TransitionFailed",
    "TransitionRefused",
    "TransportError",
    "UnconnectedFrames",
    "UnknownFrame",
    "UnknownInterface",
    "WrongThread",
    "action",
    "run",
    "running",
    "service",
    "subscription",
    "task",
    "timer",
]


def __getattr__(name: str) -> object:
    for home, names in _HOMES.items():
        if name in names:
            from importlib import import_module

            try:
                value: object = getattr(import_module(home), name)
            except Exception as error:  # whatever a file of the user's raises that hides a module of Python
                from graphflow.analysis.hidden_stdlib import hiding_file

                if text := hiding_file(error):
                    raise ImportError(text) from None  # without the frames below, which are not the user's
                raise
            globals()[name] = value
            return value
    from graphflow.runtime.mistakes.errors.name_errors import home_of
    from graphflow.runtime.mistakes.rclpy_words import translation

    home = home_of(name)
    hint = f"write from {home} import {name}" if home else translation(name, "names")
    if name[:1].isupper() and name.lower() in __all__:
        hint = "the function is written run" if name == "Run" else f"the decorator is written @{name.lower()}"
    if not hint and sys._getframe(1).f_code.co_name == "_handle_fromlist":  # of `from graphflow import ...`
        from graphflow.names import nearest

        near = nearest(name, __all__, cutoff=0.75)
        hint = f"did you mean {near!r}?" if near is not None else ""
    if hint:  # an AttributeError's text would not reach who imports the name
        raise ImportError(f"graphflow has no {name}; {hint}")
    raise AttributeError(f"module 'graphflow' has no attribute {name!r}")
