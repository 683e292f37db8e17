"""ROS 2's concepts and wire protocol in one pip install, native to asyncio."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graphflow.errors import (
        Abort,
        CallError,
        CallTimeout,
        DeadlockError,
        DeclarationError,
        DecodeError,
        EncodeError,
        GoalAborted,
        GoalCanceled,
        GoalError,
        GoalLost,
        GoalRejected,
        GraphflowError,
        LoopBlockedError,
        ParameterError,
        RemoteError,
        ServerBusy,
        ServerLost,
        ServiceUnavailable,
    )
    from graphflow.machines.goal import GoalStatus
    from graphflow.qos import Durability, History, Liveliness, Qos, Reliability
    from graphflow.runtime.context import Context
    from graphflow.runtime.declare import (
        ActionClient,
        Client,
        Group,
        Param,
        Publisher,
        Subscription,
        action,
        service,
        subscription,
        task,
        timer,
    )
    from graphflow.runtime.events import QosEvent
    from graphflow.runtime.failures import ErrorBudget
    from graphflow.runtime.node import Node
    from graphflow.runtime.run import run, running
    from graphflow.runtime.timer import TimerInfo
    from graphflow.times import Duration, Time
    from graphflow.wire.attachment import MessageInfo

__version__ = "0.1.0"

# Imported when first used: `graphflow --help` must not wait for zenoh and asyncio.
_HOMES = {
    "graphflow.errors": (
        "Abort",
        "CallError",
        "CallTimeout",
        "DeadlockError",
        "DeclarationError",
        "DecodeError",
        "EncodeError",
        "GoalAborted",
        "GoalCanceled",
        "GoalError",
        "GoalLost",
        "GoalRejected",
        "GraphflowError",
        "LoopBlockedError",
        "ParameterError",
        "RemoteError",
        "ServerBusy",
        "ServerLost",
        "ServiceUnavailable",
    ),
    "graphflow.machines.goal": ("GoalStatus",),
    "graphflow.qos": ("Durability", "History", "Liveliness", "Qos", "Reliability"),
    "graphflow.runtime.context": ("Context",),
    "graphflow.runtime.declare": (
        "ActionClient",
        "Client",
        "Group",
        "Param",
        "Publisher",
        "Subscription",
        "action",
        "service",
        "subscription",
        "task",
        "timer",
    ),
    "graphflow.runtime.events": ("QosEvent",),
    "graphflow.runtime.failures": ("ErrorBudget",),
    "graphflow.runtime.timer": ("TimerInfo",),
    "graphflow.wire.attachment": ("MessageInfo",),
    "graphflow.runtime.node": ("Node",),
    "graphflow.runtime.run": ("run", "running"),
    "graphflow.times": ("Duration", "Time"),
}

__all__ = [
    "Abort",
    "ActionClient",
    "CallError",
    "CallTimeout",
    "Client",
    "Context",
    "DeadlockError",
    "DeclarationError",
    "DecodeError",
    "Durability",
    "Duration",
    "EncodeError",
    "ErrorBudget",
    "GoalAborted",
    "GoalCanceled",
    "GoalError",
    "GoalLost",
    "GoalRejected",
    "GoalStatus",
    "GraphflowError",
    "Group",
    "History",
    "Liveliness",
    "LoopBlockedError",
    "MessageInfo",
    "Node",
    "Param",
    "ParameterError",
    "Publisher",
    "Qos",
    "QosEvent",
    "Reliability",
    "RemoteError",
    "ServerBusy",
    "ServerLost",
    "ServiceUnavailable",
    "Subscription",
    "Time",
    "TimerInfo",
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

            value: object = getattr(import_module(home), name)
            globals()[name] = value
            return value
    raise AttributeError(f"module 'graphflow' has no attribute {name!r}")
