"""Remedies in rclpy's words."""

from __future__ import annotations

from dataclasses import replace

import pytest

from graphflow.errors import Place
from graphflow.machines.rclpy_remedies import in_rclpys_words
from graphflow.machines.rings import Edge
from graphflow.machines.wait_graph import ActivityView, Call, Condition, GroupView, QueueView, SetBy, Slot, WaitGraph
from tests.flat import flat

GROUP = GroupView("g", "default callback group", "/arm", sort="callback")
OWN = GroupView("o", "callback group 'own'", "/arm", sort="callback")
THREADS = GroupView("e", "SingleThreadedExecutor", "/arm", sort="executor")
OTHERS = GroupView("f", "SingleThreadedExecutor", "/arm", sort="executor")
NOBODY = GroupView("s", "spinner", "/arm", sort="spinner")
CALL = Call("c", "/add")
TICK = ActivityView(
    "a", "timer tick", "/arm", ("g", "e"), CALL, place=Place("/x/arm.py", 12), function="tick", is_async=False
)
ADD = QueueView("q", "service add", "/arm", ("g", "e"), ("c",))
REPLY = QueueView("r", "reply /add", "/arm", ("g", "e"))


def told(edge: Edge, *activities: ActivityView, queues: tuple[QueueView, ...] = (ADD, REPLY)) -> list[str]:
    """The remedies, one line each."""
    graph = WaitGraph(
        {a.id: a for a in activities},
        {g.id: g for g in (GROUP, OWN, THREADS, OTHERS, NOBODY)},
        {q.id: q for q in queues},
    )
    return [flat(text) for text in in_rclpys_words(edge, edge, graph)]


def test_a_call_in_a_callback() -> None:
    """Another way to call, or groups and threads for the server and for the answer."""
    assert told(Edge("a", CALL, "q", "g"), TICK) == [
        "do not block in arm.py:12: future = client.call_async(request), then future.add_done_callback(...)",
        "make add and the client of /add of /arm with callback_group=MutuallyExclusiveCallbackGroup() each, "
        "and spin with MultiThreadedExecutor(num_threads=2)",
    ]


def test_a_callback_that_spins_its_node() -> None:
    """That takes the node from its executor: with groups and threads, the call would be the last thing it does."""
    [only] = told(Edge("a", CALL, "q", "g"), TICK, queues=(ADD, replace(REPLY, needs=("g", "f"))))
    assert only.startswith("do not block in arm.py:12:")


def test_only_what_is_full_is_changed() -> None:
    """Here, the answer has a group of its own already."""
    [_, apart] = told(Edge("a", CALL, "q", "g"), TICK, queues=(ADD, replace(REPLY, needs=("o", "e"))))
    assert apart == (
        "make add of /arm with callback_group=MutuallyExclusiveCallbackGroup(), "
        "and spin with MultiThreadedExecutor(num_threads=2)"
    )


def test_a_service_that_calls_becomes_a_coroutine() -> None:
    """It has to return its response, and cannot do so later."""
    [coroutine, _] = told(Edge("a", CALL, "q", "g"), replace(TICK, label="service tick"))
    assert coroutine == (
        "do not block in arm.py:12: make tick async def, and await client.call_async(request), "
        "both with callback_group=ReentrantCallbackGroup()"
    )


def test_a_coroutine_gives_back_its_thread_but_not_its_group() -> None:
    """So that the group must be another."""
    [others, apart] = told(Edge("a", CALL, "q", "g"), replace(TICK, is_async=True, holds=("g",)))
    assert others == (
        "let others run while tick awaits in arm.py:12: "
        "callback_group=ReentrantCallbackGroup() where tick and what it awaits are made"
    )
    assert apart == "make add and the client of /add of /arm with callback_group=MutuallyExclusiveCallbackGroup() each"


@pytest.mark.parametrize(
    ("via", "instead"),
    [
        (Call("goal:01", "/turn"), "send_goal_async(goal)"),
        (Call("c", "/turn/_action/send_goal"), "send_goal_async(goal)"),
        (Call("c", "/turn/_action/get_result"), "get_result_async()"),
        (Call("c", "/turn/_action/cancel_goal"), "cancel_goal_async()"),
        (Call("tick:1", "rate"), "create_timer(period, callback)"),
        (
            SetBy("self.came", ("q",)),
            "return from tick instead of waiting for self.came in arm.py:12, and go on in add",
        ),
    ],
)
def test_each_wait_has_a_way_without(via: Condition, instead: str) -> None:
    """By its kind."""
    assert instead in told(Edge("a", via, "q", "g"), replace(TICK, wait=via))[0]


def test_nobody_spins() -> None:
    """The thread that waits may spin, or another."""
    ask = replace(ADD, needs=("s",))
    assert told(Edge("a", CALL, "q", "s"), TICK, queues=(ask,)) == [
        "spin while waiting, in arm.py:12: future = client.call_async(request), "
        "rclpy.spin_until_future_complete(node, future)",
        "let another thread spin /arm before arm.py:12: "
        "threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()",
    ]


def test_nobody_spins_an_executor() -> None:
    """It has the node, so it is the one to be spun."""
    [_, other] = told(Edge("a", CALL, "q", "s"), TICK, queues=(replace(ADD, needs=("e", "s")),))
    assert other.endswith("threading.Thread(target=executor.spin, daemon=True).start()")


def test_what_only_lacks_a_thread() -> None:
    """One more will do."""
    assert told(Edge("a", Slot("e", 1), "", "e"), replace(TICK, wait=Slot("e", 1)))[-1] == (
        "use more threads: MultiThreadedExecutor(num_threads=2)"
    )
