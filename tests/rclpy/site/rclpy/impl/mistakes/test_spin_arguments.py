"""What is given to be spun in place of a node."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import pytest
from std_msgs.msg import String

import rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.impl.mistakes import spin_arguments
from rclpy.impl.mistakes.spin_arguments import check_executor
from rclpy.node import Node
from tests.rclpy.hinted import hint_of

ROS: Any = rclpy


class Lamp(Node):
    """Is given as a class."""


class Bulb:
    """Is no node."""


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (lambda n: Lamp, "spin needs a node, got the class Lamp: write spin(Lamp())"),
        (lambda n: [n], "spin needs one node, got a list: add each to an executor by executor.add_node(node)"),
        (
            lambda n: SingleThreadedExecutor(),
            "got a SingleThreadedExecutor: write executor.add_node(node), then executor",
        ),
        (
            lambda n: Bulb(),
            "spin needs a node, got a Bulb: write class Bulb(Node), and super().__init__('name') in its ",
        ),
        (lambda n: None, "spin needs a node, got None: the function that makes the node must return it"),
        (lambda n: "lamp", "spin needs a node, got 'lamp'"),
        (lambda n: rclpy.Future(), "spin needs a node first, got a Future: the future comes after the node"),
    ],
)
def test_what_is_no_node(node: Node, given: Any, text: str) -> None:
    """It is refused with what to write."""
    with pytest.raises(TypeError) as caught:
        ROS.spin(given(node))
    assert text in str(caught.value)


@pytest.mark.parametrize("call", ["spin_once", "spin_until_future_complete", "add_node"])
def test_all_that_takes_nodes(node: Node, call: str) -> None:
    """Each says its own name."""
    takes: Any = SingleThreadedExecutor().add_node if call == "add_node" else getattr(ROS, call)
    arguments: tuple[Any, ...] = (rclpy.Future(),) if call == "spin_until_future_complete" else ()
    with pytest.raises(TypeError, match=f"^{call} needs a node, got the class Lamp"):
        takes(Lamp, *arguments)


@pytest.mark.parametrize("call", ["spin", "spin_once", "spin_until_future_complete"])
def test_what_is_no_executor(node: Node, call: str) -> None:
    """It is refused with what to write: it is most often a second node, or a number of seconds."""
    arguments: dict[str, Any] = {"future": rclpy.Future()} if call == "spin_until_future_complete" else {}
    with pytest.raises(TypeError) as caught:
        getattr(ROS, call)(node, **arguments, executor=node)
    assert str(caught.value) == (
        f"{call} takes one node, got another node as its executor: "
        "add each node to one executor by executor.add_node(node), and then call executor.spin()"
    )
    with pytest.raises(TypeError) as caught:
        getattr(ROS, call)(node, **arguments, executor=0.5)
    way = "" if call == "spin" else ": write timeout_sec=0.5"
    assert str(caught.value) == f"{call} takes an executor here, got 0.5{way}"


def test_executors_of_all_kinds(node: Node) -> None:
    """None, rclpy's own, and those of the user's own kind are executors."""

    class Wrapping:
        def add_node(self, node: object) -> None: ...

    for executor in (None, SingleThreadedExecutor(), Wrapping()):
        check_executor(executor, "spin")


@pytest.mark.parametrize(
    ("given", "shown"),
    [(None, "None"), (String(), "std_msgs.msg.String(data='')"), (print, "print without parentheses")],
)
def test_what_is_no_future(node: Node, given: Any, shown: str) -> None:
    """It is refused with what returns one."""
    with pytest.raises(TypeError) as caught:
        ROS.spin_until_future_complete(node, given)
    way = "it is what call_async(request) or send_goal_async(goal) returns"
    assert str(caught.value) == f"spin_until_future_complete needs a future, got {shown}: {way}"


def test_a_node_that_is_taken_out(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """By its name it is not, which is told; a node that is not there is left alone, as in ROS 2."""
    executor: Any = SingleThreadedExecutor()
    executor.remove_node(node)
    executor.remove_node(None)
    assert caplog.messages == []
    line = inspect.currentframe().f_lineno + 1  # type: ignore[union-attr]
    executor.remove_node("node")
    assert caplog.messages == [
        f"test_spin_arguments.py:{line}: remove_node does nothing, since it takes a node and got 'node'; "
        "write executor.remove_node(node)"
    ]


def test_a_node_in_the_place_of_seconds(node: Node) -> None:
    """It is told how an executor gets its nodes."""
    executor: Any = SingleThreadedExecutor()
    assert hint_of(lambda: executor.spin_once(node)) == (
        "it takes seconds, spin_once(timeout_sec=0.1), and its nodes by executor.add_node(node)"
    )


def test_threads_that_are_no_number(node: Any) -> None:
    """They are refused: it may be a node."""
    with pytest.raises(TypeError) as caught:
        MultiThreadedExecutor("4")  # type: ignore[arg-type]
    text = "num_threads must be a number of threads, got '4': add nodes with executor.add_node(node)"
    assert str(caught.value) == text


def told_of(spin: Callable[[Node], None], node: Node, caplog: pytest.LogCaptureFixture) -> list[str]:
    """What is told of an executor while a function spins a node, until it is shut down."""
    spin_arguments._reported.clear()

    def stop() -> None:
        timer.cancel()  # it may be due again before the executor has seen the end
        rclpy.shutdown()

    timer = node.create_timer(0.01, stop)
    spin(node)
    return [r.getMessage() for r in caplog.records if "does not use" in r.getMessage()]


def unused(node: Node) -> None:
    """Make an executor, and leave it out."""
    pool = MultiThreadedExecutor()
    rclpy.spin(node)
    pool.shutdown()


def added(node: Node) -> None:
    """Add the node to an executor, and spin it with another."""
    pool = SingleThreadedExecutor()
    pool.add_node(node)
    rclpy.spin(node)


def given(node: Node) -> None:
    pool = MultiThreadedExecutor()
    rclpy.spin(node, pool)


def known(node: Node) -> None:
    pool = rclpy.get_global_executor()
    rclpy.spin(node)
    assert pool is not None


def others(node: Node) -> None:
    """Have another thread spin another node."""
    pool = SingleThreadedExecutor()
    pool.add_node(Node("other"))
    rclpy.spin(node)


def tried(node: Node) -> None:
    pool = SingleThreadedExecutor()
    pool.spin_once(timeout_sec=0)
    rclpy.spin(node)


@pytest.mark.parametrize(("spin", "kind", "line"), [(unused, "Multi", 3), (added, "Single", 4)])
def test_an_executor_that_is_not_used(
    spin: Callable[[Node], None], kind: str, line: int, node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """It is told with the line that leaves it out."""
    place = f"test_spin_arguments.py:{spin.__code__.co_firstlineno + line}"
    way = f"rclpy.spin does not use the {kind}ThreadedExecutor in pool: write rclpy.spin(node, pool)"
    assert told_of(spin, node, caplog) == [f"{place}: {way}"]


@pytest.mark.parametrize("spin", [given, known, others, tried])
def test_executors_that_are_used(spin: Callable[[Node], None], node: Node, caplog: pytest.LogCaptureFixture) -> None:
    """One that is given, the global one, and those that have other nodes or have been spun."""
    assert told_of(spin, node, caplog) == []
