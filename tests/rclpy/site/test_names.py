"""Names on classes that programs derive from, where the program's own attributes are as well."""

from __future__ import annotations

from typing import Any

import pytest
from example_interfaces.action import Fibonacci
from tf2_ros import Buffer, BufferCore

import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.waitable import Waitable

PRIVATE = {
    Waitable: "_futures",
    Node: "_clock _default_callback_group _logger _parameters _on_set_parameters_callbacks "
    "_post_set_parameters_callbacks _pre_set_parameters_callbacks",
    LifecycleNode: "_callbacks _managed_entities _state_machine _service_change_state "
    "_service_get_available_states _service_get_available_transitions _service_get_state "
    "_service_get_transition_graph",
    ActionClient: "_action_name _action_type _feedback_callbacks _goal_handles _node",
    ActionServer: "_action_name _action_type _cancel_callback _execute_callback _execute_goal _goal_callback "
    "_goal_handles _handle_accepted_callback _lock _logger _node",
    Executor: "_context _is_shutdown _wait_for_ready_callbacks",
    MultiThreadedExecutor: "_executor _futures",
    BufferCore: "_frameExists _getFrameStrings",
}
"""Private names that rclpy's classes have as well."""


def made(cls: type) -> Any:
    node = Node("n")
    if cls is Buffer:
        return Buffer(node=node)
    if cls is ActionClient:
        return ActionClient(node, Fibonacci, "a")
    if cls is ActionServer:
        return ActionServer(node, Fibonacci, "a", print)
    return cls("m") if issubclass(cls, Node) else cls()


@pytest.mark.parametrize(
    "cls", [Node, LifecycleNode, ActionClient, ActionServer, Buffer, SingleThreadedExecutor, MultiThreadedExecutor]
)
def test_ours_are_names_that_nobody_writes(cls: type) -> None:
    """A program that has an attribute `_topic` or `_status` must not take ours away."""
    rclpy.init()
    one = made(cls)
    names = {*dir(one), *vars(one)} - {*dir(object)}
    private = {name for name in names if name.startswith("_") and not name.startswith("__")}
    mangled = {name for name in private if any(name.startswith(f"_{base.__name__}__") for base in cls.__mro__)}
    known = {*" ".join(PRIVATE.get(base, "") for base in cls.__mro__).split(), "_abc_impl"}
    assert {name for name in private - mangled - known if not name.startswith("_graphflow")} == set()
    rclpy.shutdown()


OFTEN = "_service _topic _count _info _graph _resolved _destroy _recheck _expanded bell held"


class Careless(Node):
    """One whose attributes are called as it likes."""

    def __init__(self) -> None:
        super().__init__("careless")
        for name in OFTEN.split():
            setattr(self, name, 3)


class CarelessClient(ActionClient):
    """The same with an action client."""

    def __init__(self, node: Node) -> None:
        super().__init__(node, Fibonacci, "fib")
        self._status = self._goals = self._results = self._lock = 3


def test_a_careless_program_runs() -> None:
    """With topics, services, timers and goals."""
    rclpy.init()
    node = Careless()

    def answer(handle: Any) -> Any:
        handle.succeed()
        return Fibonacci.Result()

    server = ActionServer(node, Fibonacci, "fib", answer)
    client = CarelessClient(node)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    assert node.count_publishers("chatter") == 0
    sent = client.send_goal_async(Fibonacci.Goal(order=1))
    executor.spin_until_future_complete(sent, 20)
    handle: Any = sent.result()
    ended: Any = handle.get_result_async()
    executor.spin_until_future_complete(ended, 20)
    assert ended.result().status == 4
    server.destroy()
    client.destroy()
    node.destroy_node()
    rclpy.shutdown()
