"""Output of `up` while a graph comes up, runs and goes down, with the nodes' log files."""

from __future__ import annotations

import os
import select
import signal
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from graphflow.cli import exits, output
from graphflow.cli.graphs.loglines import Chosen, record
from graphflow.cli.graphs.node_rows import NodeRow, node_rows
from graphflow.domain import domain_id
from graphflow.errors import SupervisorError
from graphflow.supervisor.control.client import ControlClient
from graphflow.supervisor.last_end import guardian_report
from graphflow.supervisor.processes.process_tree import state_of
from graphflow.supervisor.rundir import SUPERVISOR_LOG, GraphRun
from graphflow.system import is_portable, terminal_name

if TYPE_CHECKING:
    from graphflow.supervisor.control.client import Event

_POLL = 0.1
"""Seconds between reads of the log files."""
GONE_LIMIT = 5.0
"""Seconds that a supervisor may take to end after its graph."""
_DOWN_LIMIT = 60.0
"""Seconds that may pass between the ends of two processes while a graph goes down."""
_SILENCE_LIMIT = 2.0
"""Seconds that a supervisor may take to answer a request."""
_SOCKET_LIMIT = 3.0
"""Seconds that a supervisor may take to notice that its socket was removed and to recreate it."""
_ANSWERS = ("stopping", "exited", "end", "error")
"""Events that answer a request to stop; others may have been sent before it arrived."""
_PUBLISHED = ("up", "step", "said", "note", "exited", "stopping", "error", "end")
"""Events of the supervisor that `up --json` prints."""
_COLOURS = (36, 33, 32, 35, 34, 31)


class LogReader:
    """Printer of the lines appended to log files, each with the name of its node.

    Args:
        width: Width of the column of names.
        chosen: Filter of lines; None for all.
        as_json: Whether to print each as a line of JSON.
    """

    def __init__(
        self, files: Iterable[Path], width: int, chosen: Chosen | None = None, *, as_json: bool = False
    ) -> None:
        self._chosen, self._as_json = chosen, as_json
        self._files = dict.fromkeys(files, (0, b""))
        self._width = width
        self._colours = {path: _COLOURS[i % len(_COLOURS)] for i, path in enumerate(self._files)}
        self._is_terminal = sys.stdout.isatty() and "NO_COLOR" not in os.environ
        self.count = 0
        """Number of lines printed."""

    def show(self, last: int | None = None) -> None:
        """Print new lines; at most the `last` of each file, if given."""
        for path, (offset, partial) in list(self._files.items()):
            try:
                with path.open("rb") as file:
                    if file.seek(0, 2) < offset:  # the log was rotated: the rest of the old one is in `.log.1`
                        partial += _rest(path.with_name(f"{path.name}.1"), offset)
                        offset = 0
                    file.seek(offset)
                    data = partial + file.read()
                    offset = file.tell()
            except FileNotFoundError:
                continue
            lines, _, rest = data.rpartition(b"\n")  # a node may be in the middle of writing the last line
            self._files[path] = (offset, rest)
            if lines:
                texts = lines.decode(errors="replace").split("\n")
                if self._chosen is not None:
                    texts = self._chosen.of(path, texts)
                self._print(path, texts if last is None else texts[len(texts) - min(last, len(texts)) :])

    def _print(self, path: Path, texts: list[str]) -> None:
        self.count += len(texts)
        name = path.stem.ljust(self._width)
        if self._as_json:
            for text in texts:
                output.as_json(record(path.stem, text))
        elif self._is_terminal:
            output.colored(name, self._colours[path], (f" | {text}" for text in texts))
        else:
            output.lines(f"{name} | {text}" for text in texts)


def _rest(path: Path, offset: int) -> bytes:
    """Read a file from an offset on; empty if there is no file."""
    try:
        with path.open("rb") as file:
            file.seek(offset)
            return file.read()
    except OSError:
        return b""


def stream(
    run: GraphRun, classes: dict[str, str], *, detach: bool, end: Callable[[], str], as_json: bool = False
) -> int:
    """Follow a graph from its start to its end, or until it is up; return the exit code of `up`.

    Args:
        end: Waits for the guardian; returns a description of how it and the supervisor ended.
        as_json: Whether to print events and logs as lines of JSON, too.
    """
    interrupts: list[int] = []
    # Noted and not raised: the graph is stopped in order, and its last events are still printed.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda got, _: interrupts.append(got))
    # Connect first: a graph that fails at once waits only for its first follower before it ends.
    try:
        nodes = node_rows(run.socket)
        with ControlClient(run.socket) as client:
            client.send(do="follow")
            followed = _Stream(run, classes, nodes, client, detach, interrupts, as_json=as_json).run()
    except SupervisorError:
        if not run.wait_gone(GONE_LIMIT):
            raise
        followed = None
    if followed is None:
        return report_loss(run, end)
    if not detach:
        run.wait_gone(GONE_LIMIT)
    return followed


class _Stream:
    """A graph as one `up` shows it, from the supervisor's events and the nodes' logs."""

    def __init__(
        self,
        run: GraphRun,
        classes: dict[str, str],
        nodes: list[NodeRow],
        client: ControlClient,
        detach: bool,
        interrupts: list[int],
        *,
        as_json: bool = False,
    ) -> None:
        self._as_json = as_json
        self._run, self._classes, self._client, self._detach = run, classes, client, detach
        self._interrupts = interrupts
        """Signals to stop, in order of arrival."""
        self._stop_sent = 0
        self._unanswered_since: float | None = None
        """Time of the oldest unanswered request to stop; None if there is none."""
        self._has_reported_silence = False
        self._nodes = nodes
        self._logs: LogReader | None = None
        self._is_up = False

    def run(self) -> int | None:
        """Return the exit code of `up`; None if the supervisor ended without reporting the end."""
        files = list(dict.fromkeys(Path(n["log"]) for n in self._nodes))
        self._logs = LogReader(files, width=max((len(f.stem) for f in files), default=0), as_json=self._as_json)
        while True:
            # Logs are files, for which nothing wakes this loop; the timeout makes it read them.
            select.select([self._client], [], [], _POLL)
            events = self._client.pending()
            if events is None:
                self._logs.show()
                return None
            for event in events:
                if event["event"] in _ANSWERS:
                    self._unanswered_since = None
                code = self._show(event)
                if code is not None:
                    return code
            if not self._detach:
                self._logs.show()
            # Signals only count: the request is sent from here, where the socket is not in use. The second one kills.
            if len(self._interrupts) > self._stop_sent:
                self._stop_sent = len(self._interrupts)
                reason = "Ctrl-C" if self._interrupts[-1] == signal.SIGINT else "SIGTERM"
                self._client.send(do="down", now=self._stop_sent > 1, reason=reason)
                self._unanswered_since = self._unanswered_since or time.monotonic()
            self._check_silence()

    def _check_silence(self) -> None:
        """Report a supervisor that does not answer; after a second request to stop, end the graph without it."""
        since = self._unanswered_since
        if since is None or time.monotonic() - since < _SILENCE_LIMIT:
            return
        if self._stop_sent > 1:
            self._unanswered_since = None
            end_silent(self._run)
        elif not self._has_reported_silence:
            self._has_reported_silence = True
            output.talk(f"{silent(self._run)}; Ctrl-C again ends the graph without it")

    def _show(self, event: Event) -> int | None:
        """Show one event; return the exit code if it is the last."""
        # A graph in the background goes on when nobody reads any more, as in `up -d GRAPH 2>&1 | head -1`.
        with suppress(BrokenPipeError) if self._detach else nullcontext():
            if self._as_json and event["event"] in _PUBLISHED:
                self._print_json(event)
            self._print(event)
        match event["event"]:
            case "up":
                self._is_up = True
            case "checked" if self._detach:
                return exits.OK
            case "end":
                has_failed = self._detach and not self._is_up
                return int(event["exit_code"]) or (exits.FAILED if has_failed else exits.OK)
        return None

    def _print_json(self, event: Event) -> None:
        more: dict[str, object] = {}
        if event["event"] == "up":
            run = self._run
            more = {"graph": run.graph, "domain": run.domain, "logs": run.logs, "nodes": self._nodes}
        output.as_json({**event, **more})

    def _print(self, event: Event) -> None:
        """Print one event as text, after the log lines that nodes wrote before it."""
        match event["event"]:
            case "step":
                mark = "done" if event["ok"] else "FAILED"
                output.talk(f"step {event['step']} {mark}: {event['text']}")
            case "said":
                output.talk(event["text"])
            case "up":
                self._greet(event["seconds"], event.get("pending", {}))
            case "note":
                output.talk(f"note: {event['text']}")
            case "stopping":
                self._show_logs()
                again = "; Ctrl-C again kills it" if event["reason"] == "Ctrl-C" else ""
                output.talk(f"stopping ({event['reason']}){again}")
            case "exited" if event["unexpected"]:
                self._report_death(event)
            case "error":
                output.error(event["message"])
            case "end":
                self._show_logs()
                output.talk(f"graph {self._run.graph} has ended")

    def _show_logs(self) -> None:
        if self._logs is not None and not self._detach:
            self._logs.show()

    def _report_death(self, event: Event) -> None:
        self._show_logs()
        names = ", ".join(event["nodes"])
        reason = f": {event['error']}" if event["error"] else ""
        follows = ""
        if event.get("again") is not None:
            follows = f"; it is started again in {event['again']:.1f} s"
        elif event.get("given_up"):
            follows = f"; given up: {event['given_up']}"
        output.error(
            f"{names} died, process {event['pid']}, {event['how']}{reason}{follows}\n  its log: {event['log']}"
        )

    def _greet(self, seconds: float, pending: Mapping[str, str]) -> None:
        run = self._run
        width = max((len(n["node"]) for n in self._nodes), default=0)
        class_width = max((len(n["class"]) for n in self._nodes), default=0)
        count = f"{len(self._nodes)} node{'' if len(self._nodes) == 1 else 's'}"
        output.talk(f"graph {run.graph} is up: {count} in domain {run.domain}, {seconds:.2f} s")
        for node in self._nodes:
            place = self._classes.get(node["class"], "")
            waits = pending.get(node["node"])
            label = node["node"] if node["is_named"] else node["node"].removeprefix("/")  # or a process
            note = f"waits for {waits}" if waits else _shown_place(place)
            output.talk(f"  {label:{width}}  {node['class']:{class_width}}  {note}")
        output.talk("")
        output.talk("In another terminal:")
        name = next((node["node"] for node in self._nodes if node["is_named"]), "")
        of_node = {
            f"graphflow node info {name}": "a node's topics, services and actions",
            f"graphflow param list {name}": "its parameters",
        }
        hints = {
            "graphflow topic list": "all topics",
            **(of_node if name else {"graphflow node list": "all nodes"}),
            "graphflow ps": "the states of the nodes",
        }
        if run.domain != domain_id():
            hints = {f"export GRAPHFLOW_DOMAIN={run.domain}": "first: the file has its own domain", **hints}
        for command, what in hints.items():
            output.talk(f"  {command:32}  {what}")
        output.talk(f"Logs are in {run.logs}")
        if self._detach:
            output.talk("Open the console with: graphflow attach\nStop with: graphflow down")
        else:
            output.talk("Stop with Ctrl-C.")
        output.talk("")


def report_loss(run: GraphRun, end: Callable[[], str]) -> int:
    """Report that the supervisor was killed, once its graph has ended; return the exit code of `up`."""
    lost = run.renewed()  # the guardian may have been replaced since the start
    has_gone = lost.wait_gone(GONE_LIMIT)
    why = guardian_report(lost) or (end() if has_gone else silent(lost))
    output.error(f"{why}\n  its log: {Path(lost.logs) / SUPERVISOR_LOG}")
    return exits.FAILED


def _shown_place(place: str) -> str:
    from graphflow.workspace.project import shown

    path, colon, line = place.partition(":")
    return f"{shown(Path(path))}{colon}{line}" if path else ""


def take_down(run: GraphRun, *, now: bool, as_json: bool = False) -> int:
    """Stop a graph, print which nodes end, and return the exit code. Its consoles show which terminal stopped it."""
    output.talk(f"stopping graph {run.graph} in domain {run.domain}")
    if not _answers(run):
        end_silent(run)
    else:
        with ControlClient(run.socket) as client:
            client.send(do="down", now=now, reason=f"down, by {terminal_name()}")
            for event in client.receive(timeout=_DOWN_LIMIT):
                if event["event"] == "exited":
                    output.talk(f"  {', '.join(event['nodes'])} ended")
                elif event["event"] == "end":
                    break
    is_down = run.wait_gone(2 * GONE_LIMIT)
    if as_json:
        output.as_json({"graph": run.graph, "domain": run.domain, "is_down": is_down})
    if not is_down:
        output.error(f"the supervisor of {run.graph}, process {run.pid}, is still running")
        return exits.TIMEOUT
    if not as_json:
        output.data(f"graph {run.graph} is down")
    return exits.OK


def _answers(run: GraphRun) -> bool:
    """Whether the supervisor answers requests; if its socket was removed, wait until it is recreated."""
    deadline = time.monotonic() + _SOCKET_LIMIT
    while not is_portable() and run.is_alive and not Path(run.socket).exists() and time.monotonic() < deadline:
        time.sleep(0.01)
    try:
        with ControlClient(run.socket) as client:
            client.send(do="hello")
            return next(client.receive(_SILENCE_LIMIT), None) is not None
    except SupervisorError:
        return False


def silent(run: GraphRun) -> str:
    """Describe the state of a supervisor that does not answer."""
    how = "is stopped" if state_of(run.pid) == "T" else "does not answer"
    return f"the supervisor, process {run.pid}, {how}"


def end_silent(run: GraphRun) -> None:
    """Kill a supervisor that does not answer; its guardian then ends the graph's processes."""
    import psutil

    if not run.is_alive:  # it has just ended
        return
    output.talk(f"{silent(run)}; killing it and ending its nodes")
    with suppress(psutil.Error):
        psutil.Process(run.pid).kill()
        if run.guardian:
            psutil.Process(run.guardian).resume()
