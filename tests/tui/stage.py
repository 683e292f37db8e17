"""A console on a graph in memory, with nodes, logs and a fake supervisor."""

from __future__ import annotations

import asyncio
import json
import time
import unicodedata
from collections.abc import AsyncIterator, Callable, Coroutine
from concurrent.futures import Future
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, Self, TypeVar

from textual import events
from textual.keys import REPLACED_KEYS, _character_to_key, _get_unicode_name_from_key
from textual.pilot import Pilot

from graphflow.errors import ServerLost
from graphflow.machines.cache import GraphCache
from graphflow.msgs import registry
from graphflow.runtime.context import Context
from graphflow.supervisor.rundir import GraphRun
from graphflow.testing import Graph
from graphflow.transport.base import Answer
from graphflow.tui.app import Console
from graphflow.tui.feeds.graph_feed import Live
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import Record
from graphflow.tui.feeds.supervision import Supervision
from graphflow.tui.layout import Layout
from graphflow.tui.panes import Content
from graphflow.tui.view import View

VERBS: dict[str, Any] = {
    "topic": {
        "help": "",
        "arguments": [],
        "options": {},
        "commands": {
            "echo": {"help": "", "arguments": ["TOPIC", "[TYPE]"], "options": {"--once": False, "--field": True}},
            "list": {"help": "", "arguments": [], "options": {"--json": False}},
        },
    },
    "param": {
        "help": "",
        "arguments": [],
        "options": {},
        "commands": {"get": {"help": "", "arguments": ["NODE", "PARAMETER"], "options": {}}},
    },
    "ps": {"help": "", "arguments": [], "options": {"--json": False}},
}

LIMIT = 30.0
T = TypeVar("T")


class Supervised(Supervision):
    """A fake supervisor that records its requests."""

    def __init__(self, nodes: list[str], folder: Path) -> None:
        run = GraphRun("id", "lab", 0, 1, 0.0, time.time(), str(folder / "lab.yaml"), "", str(folder), "", "")
        super().__init__(run, lambda _: None)
        self.asked: list[dict[str, Any]] = []
        self.nodes = {
            name: {
                "node": name,
                "state": "ready",
                "lifecycle": "",
                "pid": None,
                "since": time.time() - 65,
                "process": "",
                "class": "nodes.lab:Lab",
                "log": str(folder / f"{name[1:].replace('/', '.')}.log"),
                "restarts": 0,
                "detail": "",
            }
            for name in nodes
        }

    async def follow(self) -> None:
        await asyncio.Event().wait()

    def send(self, **request: Any) -> bool:
        self.asked.append(request)
        return True


class MemoryView:
    """The blocking view of a graph in memory, for threads."""

    def __init__(self, graph: Graph, context: Context) -> None:
        self._graph, self._context = graph, context
        self._loop = asyncio.get_running_loop()
        self._working: list[asyncio.Future[None]] = []
        self.domain = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Nothing to close."""

    @property
    def cache(self) -> GraphCache:
        return self._context.cache

    def node(self, name: str) -> str:
        return name

    def service_types(self, name: str) -> list[str]:
        return self.cache.services(hidden=True)[name]

    def wait_for_service(self, name: str, timeout: float) -> None:
        assert name in self.cache.services(hidden=True)

    def call(self, name: str, type_name: str, request: Any, timeout: float = 10.0, *, plain: bool = False) -> Any:
        type_: Any = registry.interface_class(type_name)
        return self._on_loop(lambda: self._graph.call(type_, name, request))

    def ask(self, key: str, request: bytes, timeout: float) -> Answer:
        answered: asyncio.Queue[Answer | None] = asyncio.Queue()

        async def asking() -> Answer | None:
            caller = self._context.session.open_caller(key, lambda: None)
            caller.call(request, b"", answered.put_nowait)
            return await answered.get()

        answer = self._on_loop(asking)
        if answer is None:
            raise ServerLost("nobody")
        return answer

    def _on_loop(self, work: Callable[[], Coroutine[Any, Any, T]]) -> T:
        """Run work on the loop and wait for it; do not start it after the loop has ended."""
        done: Future[T] = Future()

        async def working() -> None:
            try:
                done.set_result(await work())
            except BaseException as error:  # passed on to the waiting thread
                done.set_exception(error)

        self._loop.call_soon_threadsafe(lambda: self._working.append(asyncio.ensure_future(working())))
        return done.result(LIMIT)


def _character(key: str) -> str | None:
    """Return the character that a key types."""
    if len(key) == 1:
        return key
    try:
        return unicodedata.lookup(_get_unicode_name_from_key(REPLACED_KEYS.get(key, key)))
    except KeyError:
        return None


class Stage:
    """A console whose keys a test presses."""

    def __init__(self, console: Console, pilot: Pilot[Any]) -> None:
        self.console, self.pilot = console, pilot

    @property
    def text(self) -> str:
        """The text on the screen, one line per row."""
        self.console.screen._refresh_layout()  # Textual would do this at its next frame
        strips = self.console.screen._compositor.render_strips()
        return "\n".join("".join(segment.text for segment in strip).rstrip() for strip in strips)

    @property
    def view(self) -> View:
        view = self.console.focused_view
        assert view is not None
        return view

    @property
    def asked(self) -> list[dict[str, Any]]:
        """Requests to the supervisor, except those to save the windows."""
        supervision = self.console.hub.supervision
        assert isinstance(supervision, Supervised)
        return [r for r in supervision.asked if r["do"] != "keep_layout"]

    async def press(self, *keys: str) -> None:
        """Press keys, each when the one before has taken effect. Pilot's own method waits fifty times as long."""
        for key in keys:
            name = _character_to_key(key) if len(key) == 1 and not key.isalnum() else key
            self.console.post_message(events.Key(name, _character(name)))
            for _ in range(3):
                await self.pilot._wait_for_screen()
            deadline = time.monotonic() + LIMIT
            # A new dialog is drawn a moment later; the screen is never empty.
            while self.console.is_running and not (self.console.keyboard.is_quiet and self.text.strip()):
                assert time.monotonic() < deadline, f"{key} is not done"
                await self.pilot.pause(0.005)

    async def prefix(self, *keys: str) -> None:
        """Press the prefix, then keys."""
        await self.press("ctrl+b", *keys)

    async def type(self, text: str) -> None:
        await self.press(*["space" if c == " " else c for c in text])

    async def until(self, what: Any, why: str = "") -> None:
        """Wait until a condition holds, or a text is on the screen."""
        deadline = time.monotonic() + LIMIT
        holds = (lambda: what in self.text) if isinstance(what, str) else what
        while not holds():
            if time.monotonic() > deadline:
                raise AssertionError(f"not within {LIMIT} s: {why or what}\n{self.text}")
            await self.pilot.pause(0.02)

    async def look(self) -> None:
        """Update every view at once, and draw the result."""
        for frame in self.console.workspace.visible_frames:
            frame.view.look(time.monotonic())
            frame.title_line.refresh_if_changed()
        self.console.status.refresh()
        await self.pilot._wait_for_screen()
        await self.pilot._wait_for_screen()


@asynccontextmanager
async def stage(
    *contents: Content,
    graph: Graph | None = None,
    nodes: tuple[str, ...] = ("/talker", "/arm/left"),
    supervised: bool = True,
    size: tuple[int, int] = (100, 30),
    folder: Path = Path("/nonexistent"),
    records: list[Record] | None = None,
) -> AsyncIterator[Stage]:
    """A console with a window for each content; the first is current."""
    hub = Hub(0, Supervised(list(nodes), folder) if supervised else None, ("false",), lambda: VERBS)
    hub.logs.add(records or [])
    if graph is not None:
        context = Context(graph.network.session(asyncio.get_running_loop()), clock=graph.clock, deadlock="off")
        seen = MemoryView(graph, context)
        hub.live = Live(0, lambda _: seen)  # type: ignore[arg-type,return-value]
        await hub.live.join(context)
    else:
        hub.live = Live(0)
        hub.live.trouble = "no graph in this test"
    layout = Layout()
    for content in contents or (Content("nodes"),):
        layout.open(content.view, layout.make_pane(content))
    layout.current = layout.last = 0
    console = Console(hub, layout)
    async with console.run_test(size=size) as pilot:
        await pilot.pause()
        yield Stage(console, pilot)
        if console.is_running and not console._exit:
            await console.leave("detach")


def record(text: str, node: str = "/talker", level: int = 1, stamp: float = 1.0, number: int = 0) -> Record:
    """One line of a log."""
    return Record(stamp, level, node, text, False, "x.log", number)


def as_json(data: Any) -> Any:
    """Return data as after a round trip over the control socket."""
    return json.loads(json.dumps(data))
