"""Nodes that have a life cycle."""

from __future__ import annotations

from typing import Any

import pytest
from lifecycle_msgs import msg, srv

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.node import Node
from tests.rclpy.conftest import Spinner

OK, FAILURE, ERROR = (TransitionCallbackReturn[name] for name in ("SUCCESS", "FAILURE", "ERROR"))


def test_transitions_lead_from_state_to_state() -> None:
    """And cannot be made from where there is none."""
    rclpy.init()
    node = LifecycleNode("node")
    for step in ("configure", "activate", "deactivate", "cleanup", "configure", "shutdown"):
        assert getattr(node, f"trigger_{step}")() is OK
    assert node._state_machine.current_state == (4, "finalized")
    with pytest.raises(RCLError, match="not registered"):
        node.trigger_configure()
    with pytest.raises(TypeError, match="must be a bool"):
        LifecycleNode("other", enable_communication_interface="yes")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("answer", "recovery", "state"),
    [(FAILURE, OK, "unconfigured"), (ERROR, OK, "unconfigured"), (ERROR, FAILURE, "finalized")],
)
def test_a_transition_may_fail(answer: Any, recovery: Any, state: str) -> None:
    """Then the node is where it was, or where its recovery leads."""

    class Broken(LifecycleNode):
        def on_configure(self, state: Any) -> Any:
            assert state.label == "unconfigured"
            return answer

        def on_error(self, state: Any) -> Any:
            return recovery

    rclpy.init()
    node = Broken("node", enable_communication_interface=False)
    assert node.trigger_configure() is answer
    assert node._state_machine.current_state[1] == state


def test_a_callback_that_raises_is_an_error_that_is_told(caplog: pytest.LogCaptureFixture) -> None:
    """In ROS 2, nobody is told."""

    class Broken(LifecycleNode):
        def on_configure(self, state: Any) -> Any:
            raise ValueError("no camera")

    rclpy.init()
    node = Broken("node", enable_communication_interface=False)
    assert node.trigger_configure() is ERROR
    assert "on_configure raised ValueError: no camera" in caplog.text


def test_a_callback_without_the_state(caplog: pytest.LogCaptureFixture) -> None:
    """Is told with how it is written, as `on_configure(self)` is; errors of its own code keep their place."""

    class Broken(LifecycleNode):
        def on_configure(self) -> Any:  # type: ignore[override]
            raise AssertionError

        def on_error(self, state: Any) -> Any:
            raise TypeError("its own")

    rclpy.init()
    node = Broken("node", enable_communication_interface=False)
    assert node.trigger_configure() is ERROR
    line = Broken.on_configure.__code__.co_firstlineno
    assert f"on_configure (test_node.py:{line}): " in caplog.text
    assert "; write def on_configure(self, state):" in caplog.text
    assert "on_error raised TypeError" in caplog.text


def test_others_ask_and_change_the_state(node: Node, spin: Spinner) -> None:
    """And hear of it."""
    events: list[Any] = []
    node.create_subscription(msg.TransitionEvent, "/lc/transition_event", events.append, 10)
    lc = LifecycleNode("lc")
    spin.executor.add_node(lc)

    def call(type_: Any, name: str, **fields: Any) -> Any:
        client = node.create_client(type_, f"/lc/{name}")
        assert client.wait_for_service(5)
        future = client.call_async(type_.Request(**fields))
        spin(future.done)
        return future.result()

    assert call(srv.GetState, "get_state").current_state.label == "unconfigured"
    assert call(srv.ChangeState, "change_state", transition=msg.Transition(label="configure")).success
    assert not call(srv.ChangeState, "change_state", transition=msg.Transition(id=1)).success
    assert call(srv.ChangeState, "change_state", transition=msg.Transition(id=3)).success
    assert len(call(srv.GetAvailableStates, "get_available_states").available_states) == 11
    ways = call(srv.GetAvailableTransitions, "get_available_transitions").available_transitions
    assert [way.transition.label for way in ways] == ["deactivate", "shutdown"]
    assert len(call(srv.GetAvailableTransitions, "get_transition_graph").available_transitions) == 25
    spin(lambda: len(events) == 4)
    assert [event.goal_state.label for event in events] == ["configuring", "inactive", "activating", "active"]


def test_a_callback_that_returns_nothing() -> None:
    """It is named with its line."""

    class Lamp(LifecycleNode):
        def on_configure(self, state: Any) -> Any:
            """Return nothing."""

    rclpy.init()
    lamp = Lamp("lamp")
    line = Lamp.on_configure.__code__.co_firstlineno
    with pytest.raises(TypeError) as caught:
        lamp.trigger_configure()
    text = f"on_configure (test_node.py:{line}) must return TransitionCallbackReturn.SUCCESS, and returned None"
    assert str(caught.value) == text
