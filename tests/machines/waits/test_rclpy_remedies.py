"""Remedies in rclpy's words."""

from __future__ import annotations

from dataclasses import replace

import pytest

from graphflow.errors import Place
from graphflow.machines.waits.rclpy_remedies import in_rclpys_words, members_of
from graphflow.machines.waits.rings import Deadlock, Edge
from graphflow.machines.waits.wait_graph import (
    ActivityView,
    Call,
    Condition,
    GroupView,
    QueueView,
    SetBy,
    Slot,
    WaitGraph,
)
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
    ring = Deadlock(("a",), (edge,), (), is_likely=False)
    return [flat(text) for text in in_rclpys_words(*members_of(ring, graph), graph)]


def test_a_call_in_a_callback() -> None:
    """Another way to call, or groups and threads for the server and for the answer."""
    assert told(Edge("a", CALL, "q", "g"), TICK) == [
        "do not block in arm.py:12: future = client.call_async(request), then future.add_done_callback(...)",
        "make tick of /arm with callback_group=MutuallyExclusiveCallbackGroup(), "
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
        "make tick of /arm with callback_group=MutuallyExclusiveCallbackGroup(), "
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
    assert apart == "make tick of /arm with callback_group=MutuallyExclusiveCallbackGroup()"


@pytest.mark.parametrize(
    ("via", "instead"),
    [
        (Call("goal:01", "/turn"), "send_goal_async(goal)"),
        (Call("c", "/turn/_action/send_goal"), "send_goal_async(goal)"),
        (Call("c", "/turn/_action/get_result"), "future = goal_handle.get_result_async()"),
        (Call("c", "/turn/_action/cancel_goal"), "future = goal_handle.cancel_goal_async()"),
        (Call("c", "/other/get_parameters"), "future = client.get_parameters(...)"),
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
        "let another thread spin /arm, once, before arm.py:12 and any loop around it: "
        "threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start(), "
        "in place of any spin that comes later",
    ]


def test_nobody_spins_an_executor() -> None:
    """It has the node, so it is the one to be spun."""
    [_, other] = told(Edge("a", CALL, "q", "s"), TICK, queues=(replace(ADD, needs=("e", "s")),))
    assert other.endswith(
        "threading.Thread(target=executor.spin, daemon=True).start(), in place of any spin that comes later"
    )


def test_what_only_lacks_a_thread() -> None:
    """One more will do."""
    assert told(Edge("a", Slot("e", 1), "", "e"), replace(TICK, wait=Slot("e", 1)))[-1] == (
        "use more threads: MultiThreadedExecutor(num_threads=2)"
    )


def test_two_nodes_that_nobody_spins() -> None:
    """Both are needed: the server's, and that which takes the answer."""
    ask, reply = replace(ADD, node="/adder", needs=("s",)), replace(REPLY, needs=("s",))
    [only] = told(Edge("a", CALL, "q", "s"), TICK, queues=(ask, reply))
    assert only.startswith("let another thread spin /adder and /arm, once, before arm.py:12: executor.add_node(...)")


def test_a_ring_of_callbacks_that_keep_their_answers_out() -> None:
    """A change of one would leave the other waiting for itself."""
    theirs = GroupView("t", "default callback group", "/leg", sort="callback"), replace(OTHERS, node="/leg")
    back = Call("d", "/back")
    walk = ActivityView(
        "b", "service walk", "/leg", ("t", "f"), back, "c", Place("/x/leg.py", 7), "walk", is_async=False
    )
    queues = (replace(ADD, calls=("d",)), REPLY, QueueView("w", "reply /back", "/leg", ("t", "f")))
    graph = WaitGraph({"a": TICK, "b": walk}, {g.id: g for g in (GROUP, THREADS, *theirs)}, {q.id: q for q in queues})
    ring = Deadlock(("a", "b"), (Edge("b", CALL), Edge("a", back, "q", "g")), (), is_likely=False)
    assert [flat(text) for text in in_rclpys_words(*members_of(ring, graph), graph)] == [
        "do not block in arm.py:12: future = client.call_async(request), then future.add_done_callback(...); "
        "and do not block in leg.py:7: make walk async def, and await client.call_async(request), "
        "both with callback_group=ReentrantCallbackGroup()",
        "make tick of /arm and walk of /leg with callback_group=MutuallyExclusiveCallbackGroup() each, "
        "and spin each with MultiThreadedExecutor(num_threads=2)",
    ]


def test_a_service_that_waits_for_something_else() -> None:
    """It has to return its response: it awaits a future that the other callback sets."""
    via = SetBy("self.came", ("q",))
    [first, _] = told(Edge("a", via, "", "g"), replace(TICK, label="service look", wait=via))
    assert first == (
        "do not block in arm.py:12: make look async def with callback_group=MutuallyExclusiveCallbackGroup(), "
        "and await a rclpy.task.Future that add sets"
    )


def test_a_callback_that_its_own_next_run_would_free() -> None:
    """One group of its own would keep that out, too."""
    again = replace(ADD, label=TICK.label)
    [_, apart] = told(Edge("a", CALL, "q", "g"), TICK, queues=(again,))
    assert apart.startswith("make tick of /arm with callback_group=ReentrantCallbackGroup()")


def test_a_callback_without_a_name() -> None:
    """The line says which."""
    [_, apart] = told(Edge("a", CALL, "q", "g"), replace(TICK, label="timer <lambda>"))
    assert apart.startswith("make the timer that waits in arm.py:12 of /arm with callback_group=")


def test_a_callback_that_is_not_the_users() -> None:
    """Nobody can give it a group, nor have it go on later: the client, which is the user's, is moved."""
    [only] = told(Edge("a", CALL, "q", "g"), replace(TICK, is_inner=True))
    assert only.startswith("make the client of /add in /arm with callback_group=MutuallyExclusiveCallbackGroup()")


def test_threads_that_more_of_the_same_would_take() -> None:
    """Are not asked for: a service that calls itself has as many runs as there are threads."""
    again = replace(TICK, id="b", label="service add", holds=("e",))
    more = replace(again, id="c")
    both = in_rclpys_words_of(Edge("a", CALL, "q", "e"), replace(TICK, holds=("e",)), again, more)
    assert [text.partition(" ")[0] for text in both] == ["do"]
    one = in_rclpys_words_of(Edge("a", CALL, "q", "e"), replace(TICK, holds=("e",)), again)
    assert one[-1] == "spin with MultiThreadedExecutor(num_threads=3)"


def in_rclpys_words_of(edge: Edge, *activities: ActivityView) -> list[str]:
    return told(edge, *activities, queues=(replace(ADD, needs=("e",)), replace(REPLY, needs=("o",))))


def test_a_server_that_nobody_spins_beside_a_client_that_is_spun() -> None:
    """Both are to be spun, by this thread or another."""
    thread = replace(TICK, label="thread main", holds=("s",))
    queues = (replace(ADD, node="/server", needs=("s",)), replace(REPLY, needs=("e",)))
    [both, other] = told(Edge("a", CALL, "q", "s"), thread, queues=queues)
    assert both == (
        "spin /server as well while waiting, in arm.py:12: executor.add_node(...) for both nodes, "
        "executor.spin_until_future_complete(future)"
    )
    assert other.startswith("let another thread spin /server, once, before arm.py:12 and any loop")


def test_a_constructor_that_waits_for_a_message() -> None:
    """It goes on in a callback: a thread that spins the node needs the node, which is not made yet."""
    maker = ActivityView(
        "a",
        "thread MainThread",
        "/arm",
        ("s",),
        SetBy("self.pose", ("q",)),
        place=Place("/x/arm.py", 12),
        function="__init__",
        is_async=False,
    )
    pose = QueueView("q", "subscription on_pose", "/arm", ("s",))
    told_of = told(Edge("a", SetBy("self.pose", ("q",)), "q", "s"), maker, queues=(pose,))
    assert told_of == [
        "do not wait for self.pose in __init__, in arm.py:12: go on in on_pose, or in a timer, which returns at once "
        "until self.pose is set"
    ]
    elsewhere = replace(maker, function="main")
    assert "threading.Thread" in told(Edge("a", SetBy("self.pose", ("q",)), "q", "s"), elsewhere, queues=(pose,))[0]
