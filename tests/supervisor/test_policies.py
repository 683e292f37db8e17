"""The consequences of a process's end: restarts, together or alone, giving up, the end of the graph."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from graphflow import Context
from graphflow.errors import SupervisorError
from graphflow.graph.resolve import resolve
from graphflow.markup import source
from graphflow.supervisor.launching.debugging import debugged
from graphflow.supervisor.processes.messages import InterfacesJson, Job, ProcessEvent
from graphflow.supervisor.supervisor import Supervisor
from graphflow.testing.clock import ManualClock, settle
from graphflow.transport.memory import Network
from tests.until import eventually

QUICK = "{policy: on_failure, delay: 0.001}"


class Workers:
    """Stands for the starter: workers that do what a test says."""

    def __init__(self) -> None:
        self.spawned: list[str] = []
        self.asked: list[str] = []
        self.on_event: Callable[[ProcessEvent], None] = lambda event: None
        self.unready: set[str] = set()
        self.stubborn: set[str] = set()
        """Processes that ignore a request to end."""
        self._pid = 1000

    def begin_probe(self, classes: Sequence[str], root: str) -> None: ...

    def probed(self) -> InterfacesJson:
        return {}

    async def open(self, log: Path, on_event: Callable[[ProcessEvent], None], lost: Callable[[str], None]) -> None: ...

    def trouble(self) -> str:
        return ""

    def spawn(self, process: str, job: Job, log: str, env: dict[str, str]) -> None:
        self.spawned.append(process)
        self._pid += 1
        asyncio.get_running_loop().call_soon(self._come_up, process, self._pid, "command" in job)

    def _come_up(self, process: str, pid: int, is_program: bool) -> None:
        self.on_event({"event": "spawned", "process": process, "pid": pid})
        if not is_program and process not in self.unready:
            self.on_event({"event": "ready", "process": process, "node": process})

    def terminate(self, process: str, pid: int) -> None:
        self.asked.append(process)
        if process in self.stubborn:
            return
        asyncio.get_running_loop().call_soon(self.end, process, -15)

    def kill(self, process: str, pid: int) -> None:
        asyncio.get_running_loop().call_soon(self.end, process, -9)

    def end(self, process: str, status: int) -> None:
        """A worker has ended."""
        self.on_event({"event": "exited", "process": process, "status": status})

    async def close(self) -> None: ...


class Stage:
    """A graph whose workers a test ends."""

    def __init__(self, supervisor: Supervisor, workers: Workers, running: asyncio.Task[int]) -> None:
        self.supervisor, self.workers, self._running = supervisor, workers, running
        self.events: list[Any] = []
        supervisor.clients.subscribe(self.events.append, replay=True)

    def states(self) -> dict[str, str]:
        return {row["node"]: row["state"] for row in self.supervisor.describe()}

    async def until(self, **states: str) -> None:
        """Wait until nodes are in states."""
        wanted = {f"/{name}": state for name, state in states.items()}
        await eventually(lambda: wanted.items() <= self.states().items(), lambda: f"{wanted}, not {self.states()}")

    async def ended(self) -> int:
        async with asyncio.timeout(10.0):
            return await self._running

    def told(self, what: str) -> list[dict[str, Any]]:
        return [event for event in self.events if event["event"] == what]


@asynccontextmanager
async def graph(text: str, tmp_path: Path, *unready: str, debug: Sequence[str] = ()) -> AsyncIterator[Stage]:
    plan = debugged(resolve(source.read(text, "g.yaml"), tmp_path / "g.yaml"), debug)
    workers = Workers()
    workers.unready.update(unready)
    context = Context(Network().session(asyncio.get_running_loop()), clock=ManualClock())
    supervisor = Supervisor(plan, context, workers, tmp_path, {})  # type: ignore[arg-type]  # it is never ended
    workers.on_event = supervisor.on_event
    stage = Stage(supervisor, workers, asyncio.create_task(supervisor.run()))
    await asyncio.sleep(0)
    yield stage
    supervisor.begin_stop(now=True, reason="the test is over")
    await stage.ended()
    await context.close()


@pytest.fixture(autouse=True)
def _loop(graphflow_runner: asyncio.Runner) -> None:
    """These tests are coroutines."""


async def test_a_failure_is_started_again(tmp_path: Path) -> None:
    """It is told with the time of the next try; the others go on; the graph has ended well in the end."""
    async with graph(f"nodes: {{a: {{class: x:Y, restart: {QUICK}}}, b: {{class: x:Y}}}}", tmp_path) as stage:
        await stage.until(a="ready", b="ready")
        stage.workers.end("/a", -9)
        assert stage.states() == {"/a": "waiting", "/b": "ready"}
        (exited,) = stage.told("exited")
        assert (exited["unexpected"], exited["again"] > 0.0) == (True, True)
        await stage.until(a="ready")
        row = stage.supervisor.describe()[0]
        assert (row["restarts"], row["last_end"]) == (1, "signal SIGKILL (killed, perhaps for lack of memory)")
        stage.supervisor.begin_stop(now=False, reason="down")
        assert await stage.ended() == 0


async def test_an_end_that_is_no_failure(tmp_path: Path) -> None:
    """It ends a process for good, unless it is always to be started again."""
    text = "nodes: {a: {class: x:Y, restart: on_failure}, b: {class: x:Y, on_exit: restart}, c: {class: x:Y}}"
    async with graph(text, tmp_path) as stage:
        await stage.until(a="ready", b="ready")
        stage.workers.end("/a", 0)
        stage.workers.end("/b", 0)
        assert stage.states() == {"/a": "ended", "/b": "waiting", "/c": "ready"}
        assert stage.told("exited")[1]["unexpected"] is False


async def test_what_fails_too_often_is_given_up(tmp_path: Path) -> None:
    """And is ready for a start by hand, which begins anew."""
    text = "nodes: {a: {class: x:Y, restart: {delay: 0.001, max_restarts: 2}}, b: {class: x:Y}}"
    async with graph(text, tmp_path) as stage:
        for _ in range(3):
            await stage.until(a="ready")
            stage.workers.end("/a", 1)
        assert stage.states()["/a"] == "given_up"
        assert stage.told("exited")[-1]["given_up"] == "started again 2 times within 30 s"
        stage.supervisor.restart("/a", "a test")
        await stage.until(a="ready")
        stage.workers.end("/a", 1)
        assert stage.states()["/a"] == "waiting"
        stage.supervisor.stop("/a", "a test")
        assert stage.states()["/a"] == "ended"


async def test_a_wrong_configuration_is_not_tried_again(tmp_path: Path) -> None:
    """At the start it stops the graph, as any node that does not come up."""
    async with graph(f"nodes: {{a: {{class: x:Y, restart: {QUICK}}}}}", tmp_path, "/a") as stage:
        stage.workers.end("/a", 78)
        assert stage.told("exited")[0]["given_up"].startswith(
            "a restart would not change exit code 78 (wrong configuration)"
        )
        assert await stage.ended() == 1
        assert stage.told("stopping")[0]["reason"] == "/a did not start"


async def test_a_start_that_fails_is_tried_again(tmp_path: Path) -> None:
    """If its policy says so; the graph is up when it has succeeded."""
    async with graph(f"nodes: {{a: {{class: x:Y, restart: {QUICK}}}}}", tmp_path, "/a") as stage:
        await stage.until(a="starting")
        stage.workers.end("/a", 70)
        assert not stage.told("up")
        stage.workers.unready.clear()
        await stage.until(a="ready")
        assert stage.told("up")


@pytest.mark.parametrize(
    ("words", "status", "code", "reason"),
    [
        ("critical: true", 1, 1, "/a is critical, and has failed"),
        ("critical: true, restart: always", 78, 1, "/a is critical, and has been given up"),
        ("on_exit: shutdown", 0, 0, "/a has ended"),
        ("on_exit: shutdown", 1, 1, "/a has ended"),
    ],
)
async def test_a_graph_that_ends_with_a_node(tmp_path: Path, words: str, status: int, code: int, reason: str) -> None:
    """A failure of what is critical, or any end of what the graph is there for."""
    async with graph(f"nodes: {{a: {{class: x:Y, {words}}}, b: {{class: x:Y}}}}", tmp_path) as stage:
        await stage.until(a="ready", b="ready")
        stage.workers.end("/a", status)
        assert await stage.ended() == code
        assert stage.told("stopping")[0]["reason"].startswith(reason)


CHAIN = "nodes: {a: {class: x:Y, restart: %s}, b: {class: x:Y, after: a}, c: {class: x:Y, after: b}, d: {class: x:Y}}"


@pytest.mark.parametrize(
    ("strategy", "again"),
    [("one_for_one", ["/a"]), ("rest_for_one", ["/a", "/b", "/c"]), ("one_for_all", ["/d", "/a", "/b", "/c"])],
)
async def test_who_is_started_again_with_it(tmp_path: Path, strategy: str, again: list[str]) -> None:
    """It alone, what comes after it, or all; each when what it comes after is ready again."""
    async with graph(f"strategy: {strategy}\n" + CHAIN % QUICK, tmp_path) as stage:
        await stage.until(a="ready", b="ready", c="ready", d="ready")
        stage.workers.spawned.clear()
        stage.workers.end("/a", 1)
        await stage.until(a="ready", b="ready", c="ready", d="ready")
        assert stage.workers.spawned == again


async def test_after_an_end(tmp_path: Path) -> None:
    """A process that waits for the end of another does not keep the graph from being up."""
    text = (
        "nodes: {a: {command: [x]}, b: {class: x:Y, after: {a: done}}, c: {class: x:Y, after: {d: exited}}, "
        "d: {class: x:Y}, e: {class: x:Y, after: b}}"
    )
    async with graph(text, tmp_path) as stage:
        await stage.until(a="ready", d="ready")
        assert stage.told("up")
        assert stage.states() == {"/a": "ready", "/b": "pending", "/c": "pending", "/d": "ready", "/e": "pending"}
        with pytest.raises(SupervisorError, match="/b has not been started yet: it comes after the end of /a"):
            stage.supervisor.restart("/b", "a test")
        stage.workers.end("/a", 0)
        stage.workers.end("/d", 7)
        await stage.until(b="ready", c="ready", e="ready")
        with pytest.raises(SupervisorError, match="/d is not running: failed"):
            stage.supervisor.stop("/d", "a test")


async def test_what_can_never_come(tmp_path: Path) -> None:
    """A graph in which something waits for the good end of what has failed is stopped, and says why."""
    text = "nodes: {a: {command: [x]}, b: {class: x:Y, after: {a: done}}, c: {class: x:Y}}"
    async with graph(text, tmp_path) as stage:
        await stage.until(a="ready", c="ready")
        stage.workers.end("/a", 3)
        assert await stage.ended() == 1
        assert stage.told("stopping")[0]["reason"] == "/b waits until /a is done, and that has failed"


async def test_a_restart_while_it_is_being_stopped(tmp_path: Path) -> None:
    """It is started again when it has gone."""
    async with graph("nodes: {a: {class: x:Y}, b: {class: x:Y}}", tmp_path) as stage:
        await stage.until(a="ready")
        stage.supervisor.stop("/a", "a test")
        stage.supervisor.restart("/a", "a test")
        await stage.until(a="ready")
        assert stage.workers.spawned.count("/a") == 2
        assert stage.workers.asked == ["/a"]


async def test_nothing_is_started_again_while_the_graph_stops(tmp_path: Path) -> None:
    """Whatever the policy, and wherever it was."""
    text = "nodes: {a: {class: x:Y, restart: {policy: always, delay: 60}}, b: {class: x:Y, restart: always}}"
    async with graph(text, tmp_path) as stage:
        await stage.until(a="ready", b="ready")
        stage.workers.end("/a", 1)
        assert stage.states()["/a"] == "waiting"
        stage.supervisor.begin_stop(now=False, reason="down")
        assert await stage.ended() == 0
        assert stage.workers.spawned.count("/a") == stage.workers.spawned.count("/b") == 1


@pytest.mark.parametrize("how", ["waiting", "restarting"])
async def test_nothing_is_started_while_others_take_long_to_stop(tmp_path: Path, how: str) -> None:
    """A process that waits for its restart is stopped first, though its dependents have not ended yet."""
    text = "nodes: {a: {class: x:Y, restart: {policy: always, delay: 0.01}}, b: {class: x:Y, after: a}}"
    async with graph(text, tmp_path) as stage:
        await stage.until(a="ready", b="ready")
        stage.workers.stubborn.update(["/a", "/b"])
        if how == "waiting":
            stage.workers.end("/a", 1)
        else:
            stage.supervisor.restart("/a", "a test")
        assert stage.states()["/a"] == how
        stage.supervisor.begin_stop(now=False, reason="down")
        if how == "restarting":
            stage.workers.end("/a", -15)
        await asyncio.sleep(0.05)  # more than the delay, which runs by the loop's own clock
        assert stage.states() == {"/a": "failed" if how == "waiting" else "ended", "/b": "stopping"}
        assert stage.workers.spawned.count("/a") == 1
        stage.workers.end("/b", -15)
        assert await stage.ended() == 0


@pytest.mark.parametrize("is_debugged", [False, True])
async def test_how_long_a_start_may_take(tmp_path: Path, is_debugged: bool) -> None:
    """There is a limit, but not for a process that waits for its debugger."""
    debug = ["/a"] if is_debugged else []
    async with graph("nodes: {a: {class: x:Y}}", tmp_path, "/a", debug=debug) as stage:
        await stage.until(a="starting")
        await settle()
        assert (stage.supervisor._processes["/a"].alarm is None) is is_debugged
