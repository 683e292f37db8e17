"""Events and event handlers of launch files in Python."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.launchfiles.python.events import HANDLERS, handler_of, is_shutdown, state_change, without_functions
from graphflow.launchfiles.python.stand_ins import RecordedCall


def call(kind: str, /, *args: Any, **kwargs: Any) -> RecordedCall:
    made: RecordedCall = type(kind, (RecordedCall,), {"kind": kind})(*args, **kwargs)
    return made


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (call("Shutdown"), True),
        (call("EmitEvent", event=call("Shutdown")), True),
        (call("EmitEvent", event=call("ChangeState")), False),
        (call("LogInfo", msg="over"), False),
        (None, False),
    ],
)
def test_the_end_of_a_graph(value: object, expected: bool) -> None:
    """The action `Shutdown` ends it, and so does an event of that class."""
    assert is_shutdown(value) is expected


def test_a_change_of_state() -> None:
    """The node and the name of the transition are read from the event; an unknown number is no transition."""
    node = call("LifecycleNode", package="p", executable="e")
    for number, transition in ((3, "activate"), (7, "shutdown"), (99, None)):
        event = call("ChangeState", lifecycle_node_matcher=call("matches_action", node), transition_id=number)
        assert state_change(call("EmitEvent", event=event)) == (transition and (node, transition))


def test_handlers() -> None:
    """Events that a graph file can express are recognized where they are registered."""
    handler = call("OnProcessExit", target_action=call("Node"), on_exit=[])
    assert handler_of(call("RegisterEventHandler", handler)) == (handler, HANDLERS["OnProcessExit"])
    assert handler_of(call("RegisterEventHandler", call("OnShutdown"))) is None
    assert handler_of(handler) is None


def test_functions_are_left_out() -> None:
    """Actions stay in their order; functions are counted."""
    first, second = call("LogInfo", msg="a"), call("LogInfo", msg="b")
    opaque = call("OpaqueFunction", function=print)
    assert without_functions([first, print, second, opaque]) == ([first, second], 2)
    assert without_functions(first) == ([first], 0)
    assert without_functions(None) == ([], 0)
