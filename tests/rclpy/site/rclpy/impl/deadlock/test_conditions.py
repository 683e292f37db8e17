"""The conditions for which code waits."""

from __future__ import annotations

from typing import Any

import pytest
from std_srvs.srv import Trigger

from graphflow.machines.waits.wait_graph import Call, Join
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.deadlock import conditions
from rclpy.impl.deadlock.conditions import Conditions, Wait
from rclpy.impl.deadlock.reading import Reading
from rclpy.impl.deadlock.stacks import Level
from rclpy.node import Node
from rclpy.task import Future
from tests.rclpy.site.rclpy.impl.deadlock.test_reading import waiting_of


def test_a_future_that_is_done_holds_nothing_up(node: Node) -> None:
    """Nor does one that nothing known sets, of a thread that belongs to no node."""
    done, unknown = Future[int](), Future[int]()
    done.set_result(3)
    found = Conditions(Reading(waiting_of(node)))
    assert found.of_future(done, Level(None), node, None) == Wait()
    assert found.of_future(unknown, Level(None), None, None) == Wait()


def test_a_task_is_waited_for_by_its_id(node: Node) -> None:
    """As long as it has not ended."""
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    task: Any = executor.create_task(print)
    reading = Reading(waiting_of(node))
    assert Conditions(reading).of_future(task, Level(None), node, None) == Wait(Join(reading.id_of(task)))
    executor.spin_once(timeout_sec=1.0)
    assert Conditions(Reading(waiting_of(node))).of_future(task, Level(None), node, None) == Wait()
    executor.shutdown()


@pytest.mark.parametrize("is_ended_elsewhere", [False, True])
def test_an_answer_is_waited_for_by_its_call(
    node: Node, monkeypatch: pytest.MonkeyPatch, is_ended_elsewhere: bool
) -> None:
    """With the node of the client; unless the program ends the future itself."""
    monkeypatch.setattr(conditions, "may_be_ended", lambda *_: is_ended_elsewhere)
    other = Node("other")
    node.create_service(Trigger, "ask", lambda request, response: response)
    client = other.create_client(Trigger, "ask")
    future = client.call_async(Trigger.Request())
    (sequence,) = client.pending_requests
    wait = Conditions(Reading(waiting_of(node))).of_future(future, Level(None), node, None)
    call = Call(client.endpoint.call_id(sequence), "/ask", 1)
    assert wait == (Wait(client_node=other) if is_ended_elsewhere else Wait(call, client_node=other))


def test_code_that_waits_for_nothing_known(node: Node) -> None:
    """It may go on at any time."""
    found = Conditions(Reading(waiting_of(node)))
    assert found.of_level(Level(None), None, None) == Wait()
