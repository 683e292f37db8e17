"""Lifecycle nodes as users write them."""

from __future__ import annotations

import asyncio
import re
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import pytest

from graphflow import (
    DeclarationError,
    GoalAborted,
    GoalRejected,
    LifecycleNode,
    LifecycleState,
    Node,
    Param,
    Publisher,
    ServerInactive,
    TransitionFailed,
    TransitionRefused,
    action,
    service,
    subscription,
    task,
    timer,
)
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.lifecycle_msgs.msg import Transition, TransitionEvent
from graphflow.msgs.lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.runtime.mistakes.errors.attribute_errors import better_text
from graphflow.testing import Graph
from graphflow.testing.clock import settle

UP = ["on_configure", "open camera", "on_activate", "open stream", "task"]


class Camera(LifecycleNode):
    """Record its transitions; `trouble` makes a hook fail."""

    trouble = Param("")
    image = Publisher(String, "image")

    def __init__(self, **params: Any) -> None:
        super().__init__(**params)
        self.done: list[str] = []
        self.heard: list[str] = []

    def note(self, hook: str) -> None:
        self.done.append(hook)
        name, _, how = str(self.trouble).rpartition(" ")
        if name == hook:
            if how == "refuses":
                raise TransitionRefused("not now")
            raise RuntimeError("smoke")

    @asynccontextmanager
    async def opened(self, what: str) -> AsyncIterator[str]:
        self.done.append(f"open {what}")
        try:
            yield what
        finally:
            self.note(f"close {what}")

    async def on_configure(self) -> None:
        await self.enter(self.opened("camera"))
        self.note("on_configure")
        self.done.insert(0, self.done.pop())

    async def on_activate(self) -> None:
        self.note("on_activate")
        await self.enter(self.opened("stream"))

    async def on_deactivate(self) -> None:
        self.note("on_deactivate")

    async def on_cleanup(self) -> None:
        self.note("on_cleanup")

    async def on_shutdown(self) -> None:
        self.note("on_shutdown")

    async def on_error(self) -> None:
        self.note("on_error")

    @timer(1.0)
    async def grab(self) -> None:
        self.image.publish(String(data="picture"))

    @subscription(String, "light")
    async def lit(self, message: String) -> None:
        self.heard.append(message.data)

    @service(Trigger, "snap")
    async def snap(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True)

    @task
    async def watch(self) -> None:
        self.done.append("task")
        try:
            await asyncio.Event().wait()
        finally:
            self.done.append("task ends")


async def change(graph: Graph, label: str, number: int = 0) -> bool:
    request = ChangeState.Request(transition=Transition(id=number, label=label))
    return (await graph.call(ChangeState, "/camera/change_state", request)).success


async def state(graph: Graph) -> str:
    return (await graph.call(GetState, "/camera/get_state", GetState.Request())).current_state.label


async def test_up_and_down(graph: Graph) -> None:
    """Each level is entered on the way up and left on the way down, in reverse, after the hook."""
    node = Camera()
    await graph.start(node)
    assert node.lifecycle_state.label == "unconfigured"
    await node.trigger_configure()
    await node.trigger_activate()
    await settle()
    assert node.done == UP
    assert node.lifecycle_state.label == "active"

    node.done.clear()
    await node.trigger_deactivate()
    assert node.done == ["task ends", "on_deactivate", "close stream"]
    await node.trigger_cleanup()
    assert node.done[3:] == ["on_cleanup", "close camera"]

    await node.trigger_configure()
    await node.trigger_activate()
    await settle()
    node.done.clear()
    await node.trigger_shutdown()
    assert node.done == ["task ends", "on_shutdown", "close stream", "close camera"]
    assert node.lifecycle_state is LifecycleState.FINALIZED
    assert node.is_running


async def test_work_is_done_only_while_active(graph: Graph) -> None:
    """Timers, messages and requests; arrivals in other states are not kept."""
    node = Camera()
    await graph.start(node)
    pictures = graph.tap(String, "/image")
    light = graph.publisher(String, "/light")
    for i, step in enumerate(("", "configure", "activate", "deactivate", "cleanup")):
        if step:
            assert await change(graph, step)
        light.publish(String(data=step or "start"))
        await graph.clock.advance(1.5)
        assert len(pictures) == (0 if i < 2 else 1)
        if step == "activate":
            assert (await graph.call(Trigger, "/snap", Trigger.Request())).success
        else:
            with pytest.raises(ServerInactive, match=f"/camera is {await state(graph)}, not active"):
                await graph.call(Trigger, "/snap", Trigger.Request())
    assert node.heard == ["activate"]


async def test_what_is_published_while_not_active_is_told(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Once, with the next step; messages published during the activation are sent."""
    node = Camera()
    await graph.start(node)
    pictures = graph.tap(String, "/image")
    await settle()
    for _ in range(3):
        node.image.publish(String(data="lost"))
    told = [r.getMessage() for r in caplog.records if "not sent" in r.getMessage()]
    assert told == [
        "what is published on /image is not sent: /camera is unconfigured, not active; "
        "graphflow lifecycle set /camera configure && graphflow lifecycle set /camera activate"
    ]
    assert not node.image.is_wanted
    assert len(pictures) == 0


class Speaker(LifecycleNode):
    """Publishes in its hooks."""

    word = Publisher(String, "word")

    async def on_configure(self) -> None:
        self.word.publish(String(data="configure"))

    async def on_activate(self) -> None:
        self.word.publish(String(data="activate"))

    async def on_deactivate(self) -> None:
        self.word.publish(String(data="deactivate"))


async def test_hooks_beside_the_work_publish(graph: Graph) -> None:
    """A robot can be stopped while its driver is being deactivated."""
    node = Speaker()
    await graph.start(node)
    words = graph.tap(String, "/word")
    await settle()
    await node.trigger_configure()
    await node.trigger_activate()
    await node.trigger_deactivate()
    await settle()
    assert [w.data for w in words] == ["activate", "deactivate"]


@pytest.mark.parametrize(
    ("trouble", "steps", "ends", "done"),
    [
        ("on_configure refuses", ["configure"], "unconfigured", ["on_configure", "close camera"]),
        ("on_activate refuses", ["configure", "activate"], "inactive", ["on_activate"]),
        ("on_deactivate refuses", ["configure", "activate", "deactivate"], "active", ["on_deactivate", "task"]),
        ("on_cleanup refuses", ["configure", "cleanup"], "inactive", ["on_cleanup"]),
        ("on_shutdown refuses", ["configure", "shutdown"], "finalized", ["on_shutdown", "close camera"]),
        ("on_configure fails", ["configure"], "unconfigured", ["on_error", "close camera"]),
        ("on_activate fails", ["configure", "activate"], "unconfigured", ["on_activate", "on_error", "close camera"]),
        (
            "on_deactivate fails",
            ["configure", "activate", "deactivate"],
            "unconfigured",
            ["on_deactivate", "on_error", "close stream", "close camera"],
        ),
        ("on_cleanup fails", ["configure", "cleanup"], "unconfigured", ["on_error", "close camera"]),
        ("on_shutdown fails", ["shutdown"], "unconfigured", ["on_shutdown", "on_error"]),
        ("close stream fails", ["configure", "activate", "deactivate"], "unconfigured", ["on_error", "close camera"]),
    ],
)
async def test_hooks_that_do_not_succeed(
    graph: Graph, trouble: str, steps: list[str], ends: str, done: list[str], caplog: pytest.LogCaptureFixture
) -> None:
    """A refusal restores the previous state, an error leads to unconfigured; both release resources."""
    node = Camera(trouble=trouble)
    await graph.start(node)
    results = [await change(graph, step) for step in steps]
    await settle()
    assert results == [True] * (len(steps) - 1) + [False]
    assert await state(graph) == ends
    assert node.done[-len(done) :] == done
    text = "\n".join(r.getMessage() for r in caplog.records)
    hook = trouble.rpartition(" ")[0]
    assert (f"{hook} refused: not now" if "refuses" in trouble else "smoke") in text


async def test_an_error_in_on_error_is_the_end(graph: Graph) -> None:
    """The node is finalized, everything left, and no transition leads on."""

    class Hopeless(Camera):
        async def on_configure(self) -> None:
            await self.enter(self.opened("camera"))
            raise RuntimeError("smoke")

        async def on_error(self) -> None:
            raise RuntimeError("fire")

    node = Hopeless(name="camera")
    await graph.start(node)
    with pytest.raises(
        TransitionFailed, match="could not configure: on_configure failed: RuntimeError: smoke; it is fin"
    ):
        await node.trigger_configure()
    assert node.done == ["open camera", "close camera"]
    with pytest.raises(TransitionFailed, match="cannot configure: /camera is finalized; from there: nothing"):
        await node.trigger_configure()
    await graph.stop(node)
    assert "on_shutdown" not in node.done


async def test_every_level_is_left(graph: Graph) -> None:
    """Even if the release of one fails: a finalized node has no open resources."""

    class Stuck(Camera):
        async def on_error(self) -> None:
            self.done.append("on_error")

        async def on_deactivate(self) -> None:
            raise RuntimeError("smoke")

    node = Stuck(name="camera", trouble="close stream fails")
    await graph.start(node)
    await node.trigger_configure()
    await node.trigger_activate()
    with pytest.raises(TransitionFailed, match="it is finalized"):
        await node.trigger_deactivate()
    assert node.done[-3:] == ["on_error", "close stream", "close camera"]


async def test_a_label_of_any_length(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The log has only an excerpt: any client may send it."""
    node = Camera()
    await graph.start(node)
    assert not await change(graph, "x" * 100_000)
    assert max(len(r.getMessage()) for r in caplog.records) < 300


async def test_a_refusal_has_its_reason(graph: Graph) -> None:
    """In the error of the trigger method."""
    node = Camera(trouble="on_activate refuses")
    await graph.start(node)
    await node.trigger_configure()
    with pytest.raises(TransitionFailed, match="/camera could not activate: on_activate refused: not now; it is inact"):
        await node.trigger_activate()


async def test_what_the_services_answer(graph: Graph) -> None:
    """States and transitions by number and label, in ROS's order, and the five services of ROS."""
    node = Camera()
    await graph.start(node)
    states = await graph.call(GetAvailableStates, "/camera/get_available_states", GetAvailableStates.Request())
    assert [s.id for s in states.available_states] == [0, 1, 2, 3, 4, 10, 11, 12, 13, 14, 15]
    now, everything = [
        await graph.call(GetAvailableTransitions, f"/camera/{name}", GetAvailableTransitions.Request())
        for name in ("get_available_transitions", "get_transition_graph")
    ]
    found = [(t.transition.id, t.transition.label, t.goal_state.label) for t in now.available_transitions]
    assert found == [(1, "configure", "configuring"), (5, "shutdown", "shuttingdown")]
    assert len(everything.available_transitions) == 25


@pytest.mark.parametrize(("label", "number", "works"), [("", 1, True), ("configure", 99, True), ("", 3, False)])
async def test_requests_by_label_or_number(graph: Graph, label: str, number: int, works: bool) -> None:
    """A label wins over a number, as in ROS 2."""
    node = Camera()
    await graph.start(node)
    assert await change(graph, label, number) is works


async def test_transitions_are_published(graph: Graph) -> None:
    """Each step, the passing ones too."""
    node = Camera()
    await graph.start(node)
    events = graph.tap(TransitionEvent, "/camera/transition_event")
    await settle()
    await node.trigger_configure()
    await settle()
    assert [(e.transition.id, e.start_state.label, e.goal_state.label) for e in events] == [
        (1, "unconfigured", "configuring"),
        (10, "configuring", "inactive"),
    ]


async def test_one_transition_at_a_time(graph: Graph) -> None:
    """A second request during a hook is refused, and the state can be read."""
    gate = asyncio.Event()

    class Slow(LifecycleNode):
        async def on_configure(self) -> None:
            await gate.wait()

    node = Slow(name="camera")
    await graph.start(node)
    configuring = asyncio.create_task(node.trigger_configure())
    await settle()
    assert await state(graph) == "configuring"
    with pytest.raises(TransitionFailed, match="/camera is configuring; from there: nothing"):
        await node.trigger_shutdown()
    gate.set()
    await configuring
    assert await state(graph) == "inactive"


async def test_a_hook_that_takes_long_is_told(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """With where it waits."""

    class Slow(LifecycleNode):
        async def on_configure(self) -> None:
            await asyncio.Event().wait()

    node = Slow()
    await graph.start(node)
    asked = asyncio.create_task(node.trigger_configure())
    await graph.clock.advance(5.5)
    assert "on_configure has not returned for 5 s" in caplog.text
    asked.cancel()


async def test_stopping_ends_the_life(graph: Graph) -> None:
    """From every state: resources are released, and `on_shutdown` runs once."""
    node = Camera()
    await graph.start(node)
    await node.trigger_configure()
    await node.trigger_activate()
    await settle()
    await graph.stop(node)
    assert node.done == [*UP, "task ends", "on_shutdown", "close stream", "close camera"]


async def test_stopping_during_a_hook(graph: Graph) -> None:
    """The hook is cancelled, and its resources are released."""
    entered = asyncio.Event()

    class Slow(Camera):
        async def on_configure(self) -> None:
            await self.enter(self.opened("camera"))
            entered.set()
            await asyncio.Event().wait()

    node = Slow()
    await graph.start(node)
    asked = asyncio.create_task(node.trigger_configure())
    await entered.wait()
    await graph.stop(node)
    assert node.done == ["open camera", "on_shutdown", "close camera"]
    assert asked.cancelled()


async def test_a_handler_that_deactivates_its_node(graph: Graph) -> None:
    """It ends where it waits for that, and the node is inactive."""
    after: list[str] = []

    class Shy(LifecycleNode):
        @subscription(String, "hush")
        async def hush(self, message: String) -> None:
            await self.trigger_deactivate()
            after.append("still here")

    node = Shy()
    await graph.start(node)
    await node.trigger_configure()
    await node.trigger_activate()
    graph.publisher(String, "/hush").publish(String())
    await settle()
    assert node.lifecycle_state is LifecycleState.INACTIVE
    assert after == []


async def test_what_a_level_makes_is_gone_below_it(graph: Graph) -> None:
    """Publishers, services, timers and tasks made in a hook, also by name in the graph."""
    ticks: list[str] = []

    class Maker(LifecycleNode):
        async def on_configure(self) -> None:
            self.create_service(Trigger, "made", lambda request: Trigger.Response(success=True))
            self.create_timer(1.0, lambda: ticks.append("configured"))

        async def on_activate(self) -> None:
            self.create_timer(1.0, lambda: ticks.append("active"))
            self.spawn(self.run)

        async def run(self) -> None:
            try:
                await asyncio.Event().wait()
            finally:
                ticks.append("task ends")

    node = Maker()
    await graph.start(node)
    for _ in range(2):
        await node.trigger_configure()
        assert "/made" in [e.name for e in node.endpoints]
        await graph.clock.advance(1.5)
        assert ticks == []
        await node.trigger_activate()
        await graph.clock.advance(1.5)
        assert ticks == ["configured", "active"]
        await node.trigger_deactivate()
        await node.trigger_cleanup()
        await graph.clock.advance(1.5)
        assert ticks == ["configured", "active", "task ends"]
        assert "/made" not in [e.name for e in node.endpoints]
        ticks.clear()


async def test_a_timer_that_was_cancelled_stays_so(graph: Graph) -> None:
    """Activation does not restart a timer that the node has cancelled."""

    class Once(LifecycleNode):
        ticks = 0

        def __init__(self) -> None:
            super().__init__()
            self.clock_hand = self.create_timer(1.0, self.tick)

        def tick(self) -> None:
            self.ticks += 1
            self.clock_hand.cancel()

    node = Once()
    await graph.start(node)
    await node.trigger_configure()
    for _ in range(2):
        await node.trigger_activate()
        await graph.clock.advance(3.0)
        await node.trigger_deactivate()
    assert node.ticks == 1


async def test_a_hook_that_returns_something(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The error about rclpy's return values has the correct form."""

    class Habit(LifecycleNode):
        async def on_configure(self) -> bool:  # type: ignore[override]
            return True

    node = Habit()
    await graph.start(node)
    text = (
        r'returned True; a hook succeeds by returning None, and refuses by raise TransitionRefused\("why"\) \(test_lif'
    )
    with pytest.raises(TransitionFailed, match=text):
        await node.trigger_configure()


def test_hooks_are_checked_when_the_class_is_made() -> None:
    """As ROS 2 writes them, they would not work here."""
    with pytest.raises(DeclarationError, match=r"test_lifecycle_node.py:\d+: on_configure takes only self"):

        class WithState(LifecycleNode):
            async def on_configure(self, state: object) -> None:  # type: ignore[override]
                pass

    with pytest.raises(DeclarationError, match="on_activate must be an `async def`"):

        class Plain(LifecycleNode):
            def on_activate(self) -> None:  # type: ignore[override]
                pass

    with pytest.raises(DeclarationError, match="every node has 'trigger_configure'"):

        class Hiding(LifecycleNode):
            def trigger_configure(self) -> None:  # type: ignore[override]
                pass


async def test_an_unconfigured_node_says_what_to_do(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A warning has the next step."""
    with caplog.at_level("INFO"):
        await graph.start(Camera())
    way = "graphflow lifecycle set /camera configure && graphflow lifecycle set /camera activate"
    assert f"unconfigured: {way}, or write lifecycle: active in a graph file" in caplog.text


async def test_a_plain_node_is_not_managed(graph: Graph) -> None:
    """Its interface has `is_managed=False`, for graph files."""

    class Plain(Node):
        pass

    assert not Plain.interface().is_managed
    assert Camera.interface().is_managed


async def test_what_a_hook_makes_rests_and_is_ended(graph: Graph) -> None:
    """A publisher made on configure is silent until the node is active; a task started there ends with cleanup."""
    ended: list[str] = []

    class Maker(LifecycleNode):
        async def on_configure(self) -> None:
            self.word = self.create_publisher(String, "word")
            await self.word.wait_matched()
            self.word.publish(String(data="in the hook"))
            self.spawn(self.run)

        async def run(self) -> None:
            try:
                await asyncio.Event().wait()
            finally:
                ended.append("task")

    node = Maker()
    await graph.start(node)
    words = graph.tap(String, "/word")
    await node.trigger_configure()
    await settle()
    node.word.publish(String(data="too early"))
    await node.trigger_activate()
    node.word.publish(String(data="now"))
    await settle()
    assert [word.data for word in words] == ["now"]
    await node.trigger_deactivate()
    assert ended == []
    await node.trigger_cleanup()
    assert ended == ["task"]


async def test_goals_are_rejected_while_not_active(graph: Graph) -> None:
    """With the reason; a goal that is under way is aborted when the node rests."""

    class Server(LifecycleNode):
        @action(Fibonacci, "count")
        async def count(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
            await asyncio.Event().wait()
            raise AssertionError

    node, asker = Server(), Node("asker")
    client = asker.create_action_client(Fibonacci, "count")
    await graph.start(node, asker)
    with pytest.raises(GoalRejected, match="/server is unconfigured, not active"):
        async with client.send(Fibonacci.Goal(order=1)):
            pass
    await node.trigger_configure()
    await node.trigger_activate()
    async with client.send(Fibonacci.Goal(order=1)) as goal:
        await node.trigger_deactivate()
        with pytest.raises(GoalAborted):
            await goal.result()


async def test_remaps_of_nothing_are_told_once_the_node_is_configured(
    graph: Graph, caplog: pytest.LogCaptureFixture
) -> None:
    """Earlier, `on_configure` may still create the name."""

    class Maker(LifecycleNode):
        async def on_configure(self) -> None:
            self.create_publisher(String, "made")

    node = Maker(remap=["made:=other", "mad:=other"])
    await graph.start(node)
    assert "matches no name" not in caplog.text
    await node.trigger_configure()
    told = [r.getMessage() for r in caplog.records if "matches no name" in r.getMessage()]
    assert len(told) == 1
    assert told[0].startswith("the remap mad:=other matches no name of this node")


def test_a_transition_by_its_name_alone() -> None:
    """The error shows the method that makes it, of the node as the line calls it."""
    camera: Any = LifecycleNode("camera")
    uses: list[Callable[[], Any]] = [lambda: camera.configure, lambda: camera.activate, lambda: camera.cleanup]
    for use in uses:
        with pytest.raises(AttributeError) as caught:
            use()
        assert re.search(r"has no attribute '(\w+)'; write await camera.trigger_\1\(\)$", better_text(caught.value))
    with pytest.raises(AttributeError) as caught:
        getattr(camera, "deactivate")  # noqa: B009 - a line that does not name it
    assert better_text(caught.value).endswith("; write await it.trigger_deactivate()")
