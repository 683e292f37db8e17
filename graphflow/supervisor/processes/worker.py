"""A worker: one process of the graph, with one node or the nodes that share a `process:`."""

from __future__ import annotations

import asyncio
import faulthandler
import json
import os
import queue
import select
import signal
import socket
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Protocol

from graphflow.analysis.user_code import place_in, users_part
from graphflow.errors import GraphflowError, TransitionFailed
from graphflow.graph.checks.check import resolver
from graphflow.graph.plan import PlannedNode, Setting, node_from_json
from graphflow.interface import COMMON_PARAMETERS, Interface
from graphflow.machines.lifecycle import LifecycleState
from graphflow.names import did_you_mean
from graphflow.runtime.context import Context
from graphflow.runtime.ending import StopRequest, catch_signals
from graphflow.runtime.logs.logger import node_logger
from graphflow.runtime.logs.rosout import log_level, setup_console
from graphflow.runtime.managed.managed_core import ManagedCore
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.runtime.node_options import NodeOptions, make_within
from graphflow.runtime.process_nodes import Company
from graphflow.supervisor import logfile
from graphflow.supervisor.control.container import Container
from graphflow.supervisor.control.orders import Orders
from graphflow.supervisor.launching import debugging
from graphflow.supervisor.launching.classes import add_root, import_class
from graphflow.supervisor.processes import process_tree
from graphflow.supervisor.processes.orphaned import LOG_VARIABLE, Orphan
from graphflow.system import end_with_parent
from graphflow.transport.event_loop import loop

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graphflow.supervisor.processes.messages import NodeJson, ProcessEvent, WorkerJob

STOP_SIGNALS = tuple(getattr(signal, n) for n in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, n))
"""Signals that the preload process blocks; a worker unblocks them once it can act on them."""
PIPE_BUF = 4096
"""Bytes that a pipe accepts atomically on Linux (PIPE_BUF of pipe(7))."""
CONNECT_LIMIT = 5.0
"""Seconds that reaching the supervisor may take, over loopback."""
BEAT_EVERY = 1.0
"""Seconds between two beats of the event loop."""
EXIT_ERROR = 70
"""Exit code: a node failed while it ran."""
EXIT_CONFIGURATION = 78
"""Exit code: a node could not be created; another start would not help."""


def make_node(planned: PlannedNode, file: str) -> Node:
    """Create a node as planned.

    Args:
        file: The graph file.

    Raises:
        GraphflowError: Its class cannot be imported, or refuses what the plan gives it.
    """
    cls = import_class(planned.class_path)
    names = resolver(planned)
    overrides = {
        name: (setting.value, str(setting.place)) for name, setting in _known(planned, cls.interface()).items()
    }
    options = NodeOptions(
        names.name,
        names.namespace,
        [r.remap() for r in planned.remaps],
        overrides,
        planned.regrouping(file),
    )
    if planned.log_level:
        node_logger(planned.name).setLevel(log_level(planned.log_level))
    node = make_within(cls, options, names.name)
    if not isinstance(node, Node):
        raise GraphflowError(f"{planned.class_path} created a {type(node).__name__}, not a node")
    core = core_of(node)  # raises if the class did not call `Node.__init__`
    if isinstance(core, ManagedCore) and planned.lifecycle:
        core.target = LifecycleState[planned.lifecycle.upper()]
    return node


def _known(planned: PlannedNode, interface: Interface) -> dict[str, Setting]:
    """Return the planned parameters that the node declares; warn about others that only a launch file sets."""
    known: dict[str, Setting] = {}
    for name, setting in planned.params.items():
        is_there = interface.may_have(name) or (setting.is_unchecked and interface.dynamic_names is True)
        if is_there or not setting.is_optional:
            known[name] = setting
        elif setting.is_unchecked and name not in COMMON_PARAMETERS:
            near = did_you_mean(name, [param.name for param in interface.params])
            text = "%s: there is no parameter %r; it is left out%s"
            node_logger(planned.name).warning(text, setting.place, name, near)
    return known


class Reporter(Protocol):
    """A worker's connection to its supervisor."""

    def report(self, event: ProcessEvent) -> None: ...

    def is_open(self) -> bool:
        """Whether an event can be written without waiting for a supervisor that does not read."""

    def listen(self, stop: Callable[[], object], order: Callable[[bytes], object]) -> None:
        """Call `stop` on a request to stop, and `order` with each line that is an order.

        They are called on the loop, which must run.
        """

    def close(self) -> None:
        """Report nothing more: this process is about to end."""


class PipeReporter:
    """Events into a pipe that all workers share, orders out of one of its own; a signal stops the worker."""

    def __init__(self, pipe: int, orders: int, orphan: Orphan) -> None:
        self._pipe, self._orders, self._orphan = pipe, orders, orphan
        self._unread = b""
        orphan.end_on_sigterm()

    def report(self, event: ProcessEvent) -> None:
        with suppress(BrokenPipeError):  # the supervisor has gone, and this process will
            os.write(self._pipe, _line_within(PIPE_BUF, event))

    def is_open(self) -> bool:
        # Linux calls a pipe writable if a page is free, so an event of up to PIPE_BUF bytes fits.
        return bool(select.select([], [self._pipe], [], 0)[1])

    def close(self) -> None:
        self._orphan.end_own()

    def listen(self, stop: Callable[[], object], order: Callable[[bytes], object]) -> None:
        """Listen for orders only: signals stop this worker."""
        self._orphan.watch()
        asyncio.get_running_loop().add_reader(self._orders, self._read, order)

    def _read(self, order: Callable[[bytes], object]) -> None:
        data = os.read(self._orders, 1 << 16)
        if not data:  # the preload process has ended: no order can come
            asyncio.get_running_loop().remove_reader(self._orders)
        *lines, self._unread = (self._unread + data).split(b"\n")
        for line in lines:
            order(line)


def _line_within(bound: int, event: ProcessEvent) -> bytes:
    """Encode an event as a line; a long error is cut, for a pipe keeps only writes of up to PIPE_BUF bytes whole."""
    plain: dict[str, object] = {**event}
    line = json.dumps(plain).encode()
    while len(line) >= bound and isinstance(error := plain.get("error"), str) and error:
        plain["error"] = error[: len(error) // 2]
        line = json.dumps(plain).encode()
    return line + b"\n"


class SocketReporter:
    """A connection to the supervisor for this worker alone; when it breaks, the supervisor is dead, and so is this."""

    def __init__(self, port: int, token: str, process: str) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=CONNECT_LIMIT)
        self._socket.settimeout(None)
        self._received: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self._wake: Callable[[], object] = lambda: None
        self._send({"token": token, "process": process})
        threading.Thread(target=self._listen, name="graphflow-supervisor", daemon=True).start()

    def report(self, event: ProcessEvent) -> None:
        self._send(event)

    def _send(self, message: Mapping[str, object]) -> None:
        self._socket.sendall(json.dumps(message).encode() + b"\n")

    def is_open(self) -> bool:
        return bool(select.select([], [self._socket], [], 0)[1])

    def listen(self, stop: Callable[[], object], order: Callable[[bytes], object]) -> None:
        loop = asyncio.get_running_loop()

        def take() -> None:
            while not self._received.empty():
                line = self._received.get()
                stop() if json.loads(line)["do"] == "stop" else order(line)

        # Before `take`, so that no line falls between the two.
        self._wake = lambda: loop.call_soon_threadsafe(take)
        take()  # lines that came before

    def close(self) -> None:
        """Do nothing: the supervisor ends what this process leaves."""

    def _listen(self) -> None:
        # Not on the loop: even a node whose loop is blocked must not outlive its supervisor.
        with self._socket.makefile("rb") as lines, suppress(OSError):  # an error counts as the end
            for line in lines:
                self._received.put(line)
                self._wake()
        _end_children()
        os._exit(EXIT_ERROR)


def _end_children() -> None:
    """End the processes that this one has started."""
    import psutil

    for child in psutil.Process().children(recursive=True):
        with suppress(psutil.NoSuchProcess):
            child.kill()


def main(job: WorkerJob, reporter: Reporter) -> None:
    """Run a worker to its end; does not return."""
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, STOP_SIGNALS)
    # By descriptor: `write_to` replaces `sys.stderr`, and a rotation the file behind it.
    faulthandler.enable(2)
    process = job["process"]
    process_tree.name_process(process.rpartition("/")[2], " ".join(str(node["name"]) for node in job["nodes"]))
    if "log" in job:
        logfile.write_to(job["log"], lambda why: reporter.report({"event": "log_lost", "process": process, "why": why}))
    if hasattr(signal, "SIGUSR2"):
        faulthandler.register(signal.SIGUSR2, 2)  # `kill -USR2` logs where a process hangs, even in C
    setup_console()
    code = 0
    try:
        if job["debug"]:
            debugging.wait_for_debugger(
                lambda port: reporter.report({"event": "debugging", "process": process, "port": port})
            )
        add_root(job["root"])
        nodes = [_make(job, reporter, data) for data in job["nodes"]]
    except Exception as error:  # importing and creating nodes runs the user's code, which may raise anything
        _log_failure(error)
        reporter.report({"event": "failed", "process": process, "error": _one_line(error)})
        code = EXIT_CONFIGURATION
    else:
        code = loop.run(_run(nodes, job, reporter))
    # `os._exit` flushes nothing.
    sys.stdout.flush()
    sys.stderr.flush()
    reporter.close()
    # Zenoh's threads can keep an interpreter from ending.
    os._exit(code)


async def _run(nodes: list[Node], job: WorkerJob, reporter: Reporter) -> int:
    process = job["process"]
    stop = StopRequest()
    catch_signals(stop)
    ready: list[Node] = []

    def is_ready(node: Node) -> None:
        ready.append(node)
        reporter.report({"event": "ready", "process": process, "node": node.full_name})

    context = obeying = None
    beating = asyncio.create_task(_beat(reporter, process))
    try:
        context = await Context.open(
            job["domain"],
            mode=job["mode"],
            checked=True,
            deadlock=job["deadlock"],
            call_timeout=job["call_timeout"],
        )
        if job["debug"]:
            context.search.watchdog.close()  # a loop that stands at a breakpoint is not blocked
        company = Company(context, stop, is_ready)
        orders = Orders(company, process, partial(_make, job, reporter), reporter.report)
        orders.count(nodes)
        if job["allow_control"]:
            Container(nodes[0], orders, process, job["root"], reporter.report)
        reporter.listen(stop.set, orders.take)
        obeying = asyncio.create_task(orders.run())
        await company.run(nodes)
    except Exception as error:  # nodes run the user's code, which may raise anything
        at_start = len(ready) < len(nodes)
        if at_start and not any(core_of(node).failure is error for node in nodes):  # that node has logged it
            _log_failure(error)
        reporter.report({"event": "failed", "process": process, "error": _one_line(error)})
        is_for_good = isinstance(error, GraphflowError) and not isinstance(error, TransitionFailed)
        return EXIT_CONFIGURATION if at_start and is_for_good else EXIT_ERROR
    finally:
        beating.cancel()
        if obeying is not None:
            obeying.cancel()
            await asyncio.gather(obeying, return_exceptions=True)
        if context is not None:
            await context.close()
    return 0


def _make(job: WorkerJob, reporter: Reporter, described: NodeJson) -> Node:
    """Create a node of this worker."""
    node = make_node(node_from_json(described), job["file"])
    core = core_of(node)
    if isinstance(core, ManagedCore):
        core.on_state = partial(_report_state, reporter, job["process"], node.full_name)
    return node


def _report_state(reporter: Reporter, process: str, node: str, state: LifecycleState) -> None:
    if reporter.is_open():
        reporter.report({"event": "lifecycle", "process": process, "node": node, "state": state.label})


async def _beat(reporter: Reporter, process: str) -> None:
    """Report that the loop goes round, as long as it does."""
    while True:
        try:
            if reporter.is_open():
                reporter.report({"event": "beat", "process": process})
        except OSError:  # the supervisor has gone, and this process will
            return
        await asyncio.sleep(BEAT_EVERY)


def _log_failure(error: Exception) -> None:
    import logging

    expected = isinstance(error, GraphflowError)
    trace = None if expected else (type(error), error, users_part(error))
    logging.getLogger("graphflow").error("%s", _one_line(error), exc_info=trace)


def _one_line(error: Exception) -> str:
    place = place_in(error)
    explain(error)
    text = str(error) if isinstance(error, GraphflowError) else f"{type(error).__name__}: {error}"
    return text if not place or place in text else f"{text} ({place})"


def become(log: str, env: dict[str, str], parent: int) -> None:
    """Turn a new child into a worker's process: session, signals, stdin, log file, environment."""
    # Its own process group, by which it is ended together with what it has started (`kill_group`).
    os.setsid()
    end_with_parent(parent, signal.SIGTERM)
    # These settings, and the wake-up descriptor, are the preload process's own; a fork inherits them.
    for number in (*STOP_SIGNALS, signal.SIGCHLD):
        signal.signal(number, signal.SIG_DFL)
    signal.set_wakeup_fd(-1)
    null = os.open(os.devnull, os.O_RDONLY)
    os.dup2(null, 0)
    os.close(null)
    out = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    os.dup2(out, 1)
    os.dup2(out, 2)
    os.close(out)
    os.environ.update(env)
    _line_buffered()


def _line_buffered() -> None:
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(line_buffering=True)  # type: ignore[union-attr]


def _start() -> None:
    """Run as a program: with `PIPE PIPE PARENT` under a preload process, else with `PORT`; the job is on stdin."""
    _line_buffered()
    if len(sys.argv) == 4:
        status, orders, parent = map(int, sys.argv[1:])
        end_with_parent(parent, signal.SIGTERM)
        main(
            json.load(sys.stdin), PipeReporter(status, orders, Orphan(parent, status, orders, os.environ[LOG_VARIABLE]))
        )
    start = json.load(sys.stdin)
    main(start["job"], SocketReporter(int(sys.argv[1]), start["token"], start["job"]["process"]))


if __name__ == "__main__":
    _start()
