"""Events and event handlers of launch files in Python, as recorded calls."""

from __future__ import annotations

from typing import NamedTuple

from graphflow.launchfiles.python.calls import code_of
from graphflow.launchfiles.python.stand_ins import RecordedCall


class HandlerForm(NamedTuple):
    """The arguments of an event handler class, and the outcome that its event stands for."""

    target: str
    """Argument with the action that is waited for."""
    then: str
    """Argument with the actions that follow."""
    outcome: str
    """Value of `after:` in a graph file."""


HANDLERS = {
    "OnProcessExit": HandlerForm("target_action", "on_exit", "exited"),
    "OnExecutionComplete": HandlerForm("target_action", "on_completion", "exited"),
    "OnProcessStart": HandlerForm("target_action", "on_start", "ready"),
    "OnStateTransition": HandlerForm("target_lifecycle_node", "entities", "ready"),
}
"""Event handlers that a graph file can express."""
LEFT_OUT = {
    "OnProcessIO": "OnProcessIO is left out: what a process prints is in its log, and the function is not called",
    "OnShutdown": "OnShutdown is left out: nothing is done when the graph stops",
}
"""Event handlers that are left out, with the remark on each."""
STATES = {"configure": "inactive", "activate": "active"}
"""Lifecycle states by the transition that leads to them."""
PROCESSES = ("Node", "LifecycleNode", "ExecuteProcess", "ExecuteLocal")
"""Actions that have an `on_exit`."""
_TRANSITIONS = {1: "configure", 2: "cleanup", 3: "activate", 4: "deactivate", **dict.fromkeys((5, 6, 7), "shutdown")}
"""Transitions by the numbers of lifecycle_msgs/msg/Transition."""


def is_shutdown(value: object) -> bool:
    """Return whether a value is the Shutdown event or action, or emits it."""
    event = value.get("event", 0) if isinstance(value, RecordedCall) and value.kind == "EmitEvent" else value
    return isinstance(event, RecordedCall) and event.kind == "Shutdown"


def state_change(value: object) -> tuple[RecordedCall, str] | None:
    """Return the lifecycle node and the transition of an action that emits ChangeState; None for any other value."""
    event = value.get("event", 0) if isinstance(value, RecordedCall) and value.kind == "EmitEvent" else None
    if not isinstance(event, RecordedCall) or event.kind != "ChangeState":
        return None
    matcher, transition = event.get("lifecycle_node_matcher"), _TRANSITIONS.get(event.get("transition_id"))
    node = matcher.get("action", 0) if isinstance(matcher, RecordedCall) and matcher.kind == "matches_action" else None
    return (node, transition) if isinstance(node, RecordedCall) and transition else None


def handler_of(value: object) -> tuple[RecordedCall, HandlerForm] | None:
    """Return the event handler that an action registers, if a graph file can express it."""
    if not isinstance(value, RecordedCall) or value.kind != "RegisterEventHandler":
        return None
    handler = value.get("event_handler", 0)
    if not isinstance(handler, RecordedCall) or handler.kind not in HANDLERS:
        return None
    return handler, HANDLERS[handler.kind]


def without_functions(then: object) -> tuple[list[RecordedCall], int]:
    """Return the actions that follow an event, and the number of functions among them, which are never called."""
    whole = list(then) if isinstance(then, (list, tuple)) else [] if then is None else [then]
    kept = [one for one in whole if isinstance(one, RecordedCall) and code_of(one) is None]
    return kept, len(whole) - len(kept)
