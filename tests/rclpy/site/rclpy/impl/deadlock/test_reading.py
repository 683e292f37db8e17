"""The nodes, entities and runs of a process, as they are read."""

from __future__ import annotations

from typing import Any

from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.deadlock.reading import Reading
from rclpy.impl.deadlock.waiting import Waiting
from rclpy.node import Node
from rclpy.task import Future


def waiting_of(node: Node) -> Waiting:
    life = node.context.life
    assert life is not None
    (found,) = life.network().elsewhere
    assert isinstance(found, Waiting)
    return found


def tick() -> None:
    """Do nothing."""


def test_ids_are_those_of_objects(node: Node) -> None:
    """Of one object always the same, of two never, in whatever reading."""
    timer, other = node.create_timer(9.0, tick), node.create_timer(9.0, tick)
    first, second = Reading(waiting_of(node)), Reading(waiting_of(node))
    assert first.id_of(timer, "q") == second.id_of(timer, "q") != first.id_of(other, "q")
    assert first.tick_of(timer) == f"tick:{first.id_of(timer, 'q')}"
    assert first.id_of(timer, "q").startswith(f"{first.zid}:q")


def test_entities_have_their_nodes_and_roles(node: Node) -> None:
    """Also those of other nodes of the context."""
    other = Node("other")
    mine, others = node.create_timer(9.0, tick), other.create_timer(9.0, tick)
    reading = Reading(waiting_of(node))
    assert reading.nodes == [node, other]
    assert [reading.owners[timer] for timer in (mine, others)] == [node, other]
    assert reading.roles[mine].label == "timer tick"


def test_a_suspended_task_is_one_of_the_executors_node(node: Node) -> None:
    """It is named for its function, and has no thread."""
    executor, future = SingleThreadedExecutor(), Future[Any]()

    async def wait() -> None:
        await future

    executor.add_node(node)
    task: Any = executor.create_task(wait)
    executor.spin_once(timeout_sec=1.0)
    reading = Reading(waiting_of(node))
    assert task in reading.runs
    assert task not in reading.levels
    assert (reading.node_of(task), reading.role_of(task).label) == (node, "task wait")
    executor.shutdown()
