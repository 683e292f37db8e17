"""Open the console, and handle the ways in which it is left."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Mapping
from pathlib import Path

os.environ["TEXTUAL_FPS"] = "20"  # read by Textual when it is imported

from graphflow.domain import go_to
from graphflow.errors import SupervisorError
from graphflow.supervisor.control.client import ControlClient
from graphflow.supervisor.rundir import GraphRun, running
from graphflow.system import collect_normally
from graphflow.tui.app import Console
from graphflow.tui.commands.history import History, history_file
from graphflow.tui.feeds.hub import Hub, Verbs
from graphflow.tui.feeds.supervision import Event, NodeRow, Supervision
from graphflow.tui.layout import Layout
from graphflow.tui.widgets.colours import DARK
from graphflow.tui.widgets.graphics import ask_terminal
from graphflow.tui.widgets.welcome import is_first_visit

FAILED = "failed"
"""The result of a console that failed by a defect of its own."""
PREFIX_VARIABLE, THEME_VARIABLE = "GRAPHFLOW_PREFIX", "GRAPHFLOW_THEME"


class Left:
    """The end of a console session: how it was left, and the graph's exit code if the graph has ended.

    `how` is `detach`, `stop` or `failed`; from a guided tour also `next`, or `fixed` for the repaired example.
    """

    def __init__(self, how: str, run: GraphRun | None, exit_code: int | None) -> None:
        self.how, self.run, self.exit_code = how, run, exit_code


def open_console(
    run: GraphRun | None,
    domain: int,
    *,
    command: tuple[str, ...],
    verbs: Callable[[], Verbs],
    prefix: str | None = None,
    layout: Mapping[str, object] | None = None,
) -> Left:
    """Show the console until it is left, following it from graph to graph.

    Args:
        run: The run to attach to; None for nodes without a supervisor of ours.
        command: The command line that starts `graphflow`.
        verbs: Reads the verbs of the command line.
        prefix: The prefix key, from the command line.
        layout: The initial windows; None for those saved with the run, the graph file's, or the default.

    Raises:
        SupervisorError: The supervisor does not answer.
    """
    while True:
        if run is not None:
            go_to(run.domain, run.endpoint)
            _log_to(Path(run.logs) / f"console-{os.getpid()}.log")
        how, exit_code = _show(run, domain, command, verbs, prefix, layout)
        if not how.startswith("switch "):
            return Left(how, run, exit_code)
        socket = how.removeprefix("switch ")
        # The chosen graph may have ended meanwhile; then the console returns to the one before.
        run = next((r for r in running() if r.socket == socket), run)
        assert run is not None
        domain, layout = run.domain, None  # which was for the first graph only


def _show(
    run: GraphRun | None,
    domain: int,
    command: tuple[str, ...],
    verbs: Callable[[], Verbs],
    prefix: str | None,
    layout: Mapping[str, object] | None,
) -> tuple[str, int | None]:
    hub = Hub(domain, None, command, verbs, History(history_file()))
    hello: Event = {}
    app: Console | None = None
    if run is not None:
        hello, rows = _initial_state(run)

        def on_event(event: Event) -> None:
            if app is not None:
                app.handle_supervisor_event(event)

        hub.supervision = Supervision(run, on_event)
        hub.supervision.hello = hello
        hub.supervision.nodes = {row["node"]: row for row in rows}
    section = hello.get("console") or {}
    app = Console(
        hub,
        _layout(layout, hello.get("layout"), hello.get("console")),
        prefix or os.environ.get(PREFIX_VARIABLE) or section.get("prefix") or _usual_prefix(),
        os.environ.get(THEME_VARIABLE) or section.get("theme") or DARK.name,
        welcome=is_first_visit(),
    )
    collect_normally()
    ask_terminal()
    how = app.run() or FAILED
    return how, hub.supervision.exit_code if hub.supervision is not None else None


def _usual_prefix() -> str:
    """Return the default prefix. Inside tmux it must not be tmux's own, which would never arrive."""
    return "ctrl+a" if os.environ.get("TMUX") else "ctrl+b"


def _initial_state(run: GraphRun) -> tuple[Event, list[NodeRow]]:
    """Read the supervisor's greeting and nodes, so that the first frame is already complete."""
    with ControlClient(run.socket) as client:
        client.send(do="hello")
        hello = next(client.receive(), {})
    with ControlClient(run.socket) as client:
        client.send(do="ps")
        rows = next(client.receive(), {}).get("nodes", [])
    return hello, rows


def _layout(*choices: Mapping[str, object] | None) -> Layout | None:
    """Return the first of several saved layouts that can be read."""
    for data in choices:
        if data and data.get("windows"):
            try:
                return Layout.from_json(data)
            except ValueError:
                logging.getLogger("graphflow.console").warning("the windows saved with the run cannot be read")
    return None


def _log_to(path: Path) -> None:
    """Write the log to a file: the terminal belongs to the console."""
    logger = logging.getLogger()
    for handler in list(logger.handlers):
        logger.removeHandler(handler)
        handler.close()
    try:
        logger.addHandler(logging.FileHandler(path, delay=True))
    except OSError as error:
        raise SupervisorError(f"{path}: {error.strerror}") from None
