"""The launch of a graph: from `graphflow up` to the start of the first node.

The command forks the guardian before anything heavy is imported. The guardian forks the supervisor, and that at once
the preload process, so that imports there, reading the file here and waiting in the command overlap. An error before
the graph runs goes back over a report pipe, as the command's exit code and message.

From the first moment the command has one end of a *lifeline*: when it ends without having let go, however it ends, the
graph goes down, or never comes up.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias, TypedDict

from graphflow.supervisor.processes import process_tree
from graphflow.supervisor.processes.guardian import guard, leave_note
from graphflow.supervisor.processes.lifeline import LET_GO, Lifeline
from graphflow.supervisor.starts import ANNOUNCEMENT
from graphflow.system import chosen_loop, collect_normally, detached, is_portable, offer_ros2

if TYPE_CHECKING:
    from graphflow.graph.checks.check import Interfaces
    from graphflow.graph.plan import Plan
    from graphflow.runtime.context import Context
    from graphflow.supervisor.processes.starter import Starter
    from graphflow.supervisor.rundir import GraphRun, RunDirectory

GONE = "its terminal went away"


class Accepted(TypedDict):
    """The report of a graph that is being brought up."""

    ok: Literal[True]
    run: dict[str, Any]
    """The run file's content."""
    classes: dict[str, str]
    """Places of the node classes, by class path."""


class Refused(TypedDict):
    """The report of a graph that cannot be started."""

    ok: Literal[False]
    exit_code: int
    message: str


Report: TypeAlias = Accepted | Refused


class LaunchJob(TypedDict):
    """The parameters of `launch`, for the supervisor."""

    file: str
    given: list[str]
    domain: int | None
    only: list[str]
    debug: list[str]
    watch: bool


class Launched(NamedTuple):
    """The command's connections to a supervisor."""

    report: int
    """The reading end of the report pipe."""
    lifeline: int
    """The command's end of the lifeline."""
    wait: Callable[[], str]
    """Waits until the supervisor and its graph have ended; returns the cause in words."""

    def let_go(self) -> None:
        """Let the graph outlive this command, whose end the lifeline still shows."""
        with suppress(OSError):  # it may have ended
            os.write(self.lifeline, LET_GO)


def launch(
    file: Path,
    given: list[str],
    domain: int | None,
    only: Sequence[str] = (),
    debug: Sequence[str] = (),
    *,
    watch: bool = False,
) -> tuple[Report, Launched]:
    """Start a supervisor for a graph file; returns when the graph is being brought up or has been refused.

    Args:
        file: The graph file.
        given: `name:=value` arguments.
        domain: See `domain.domain_id`.
        only: Nodes to start; empty for all.
        debug: Nodes whose processes wait for a debugger.
        watch: Restart nodes when their source changes.

    Raises:
        UsageFault: The environment selects an event loop that there is not.
    """
    chosen_loop()
    offer_ros2()
    ANNOUNCEMENT.begin(file)
    begin = _begin_portable if is_portable() else _begin_forked
    launched = begin(
        {"file": str(file), "given": given, "domain": domain, "only": list(only), "debug": list(debug), "watch": watch}
    )
    data = b""
    try:
        while not data.endswith(b"\n") and (chunk := os.read(launched.report, 65536)):
            data += chunk
    finally:
        os.close(launched.report)
        ANNOUNCEMENT.end()
    if not data.endswith(b"\n"):
        return {"ok": False, "exit_code": 1, "message": f"{launched.wait()} before the graph was up"}, launched
    report: Report = json.loads(data)
    if not report["ok"]:
        launched.wait()
    return report, launched


def _begin_forked(job: LaunchJob) -> Launched:
    report, write = os.pipe()
    watched, lifeline = os.pipe()
    noted, note = os.pipe()
    # A fork copies what is buffered, which both processes would write.
    sys.stdout.flush()
    sys.stderr.flush()
    pid = os.fork()
    if pid == 0:
        try:
            os.close(report)
            # Or the supervisor would hold its own lifeline, and never see the command's end.
            os.close(lifeline)
            ANNOUNCEMENT.leave()
            # Away from the terminal: its Ctrl-C is for the command, which stops the graph in order.
            os.setsid()
            # Passed on: a supervisor that called getppid() might do so after the guardian's end.
            process = _Launch(job, write, watched, note, guardian=os.getpid())
            guard(process.supervise, noted, (write, watched, note))
        finally:
            os._exit(1)
    for fd in (write, watched, noted, note):
        os.close(fd)
    return Launched(report, lifeline, lambda: _end_of(pid))


def _end_of(guardian: int) -> str:
    """Wait for the guardian, which ends with the supervisor's exit code; returns the cause of the end in words."""
    from graphflow.machines.process import Exit

    code = os.waitstatus_to_exitcode(os.waitpid(guardian, 0)[1])
    if code < 0:
        return f"the guardian, process {guardian}, was ended by {Exit.of_status(code)}, and the supervisor with it"
    return f"the supervisor was ended by {Exit.of_status(128 - code if code > 128 else code)}"


def _begin_portable(job: LaunchJob) -> Launched:
    import subprocess

    command = [sys.executable, "-P", "-m", "graphflow.supervisor.launching.launch"]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0, **detached())
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(json.dumps(job).encode() + b"\n")
    wait = lambda: f"the supervisor, process {process.pid}, was ended by code {process.wait()}"  # noqa: E731
    return Launched(os.dup(process.stdout.fileno()), _kept(process.stdin), wait)


def _kept(stream: IO[bytes]) -> int:
    """Duplicate a stream's descriptor, so that it outlives the stream."""
    with stream:
        return os.dup(stream.fileno())


def _end_at_once(directory: RunDirectory | None = None) -> None:
    """End this process, which has started nothing yet, at once."""
    if directory is None:
        os._exit(1)
    with directory.changing:  # so that no other thread writes into the directory any more
        try:
            directory.release()
        finally:
            os._exit(1)


class _Launch:
    """The supervisor's process, from the fork to the end of the graph.

    Args:
        report: The pipe to the command.
        lifeline: The supervisor's end of the lifeline.
        note: The pipe to the guardian; -1 for none.
        guardian: The guardian's process id; 0 for none.
    """

    def __init__(self, job: LaunchJob, report: int, lifeline: int, note: int = -1, guardian: int = 0) -> None:
        self._file, self._given, self._domain, self._only = Path(job["file"]), job["given"], job["domain"], job["only"]
        self._is_watching, self._debug = bool(job["watch"]), job["debug"]
        self._report_pipe, self._lifeline, self._note = report, Lifeline(lifeline, _end_at_once), note
        self._guardian = guardian
        self._was_cut = False
        self._starter: Starter

    def supervise(self) -> int:
        """Bring the graph up and supervise it to its end; returns the exit code."""
        from graphflow.errors import GraphFileError, GraphflowError, SupervisorError
        from graphflow.supervisor.processes.starter import make_starter

        for name in ("SIGINT", "SIGHUP"):
            if hasattr(signal, name):
                signal.signal(getattr(signal, name), signal.SIG_IGN)
        process_tree.name_process("gf-supervisor", f"supervisor of {self._file}")
        process_tree.adopt_orphans()  # the nodes, if the preload process ends
        starter = None
        try:
            keep = (self._report_pipe, *(fd for fd in (self._note,) if fd >= 0))
            starter = self._starter = make_starter(keep)
            self._lifeline.watch()
            return self._run()
        except GraphFileError as error:
            count = len(error.problems)
            return self._refuse(2, f"{error}\n{count} problem{'s' if count > 1 else ''}; nothing was started")
        except SupervisorError as error:
            return self._refuse(error.exit_code, str(error))
        except GraphflowError as error:
            return self._refuse(1, str(error))
        except BaseException:  # a forked child: it must answer the waiting command, not unwind into its parent's code
            import traceback

            return self._refuse(1, f"the supervisor failed:\n{traceback.format_exc()}")
        finally:
            if starter is not None:
                starter.end()

    def _report(self, report: Report) -> None:
        if self._report_pipe < 0:  # the command already knows that the graph is up; later errors go to the log
            sys.stderr.write(f"{report}\n")
            return
        try:
            os.write(self._report_pipe, json.dumps(report).encode() + b"\n")
        except OSError:  # the command was killed meanwhile
            return

    def _refuse(self, exit_code: int, message: str) -> int:
        self._report({"ok": False, "exit_code": exit_code, "message": message})
        return exit_code

    def _run(self) -> int:
        import asyncio

        from graphflow.domain import domain_id
        from graphflow.errors import GraphFileError
        from graphflow.graph.checks.check import check, step_type
        from graphflow.graph.resolve import load
        from graphflow.supervisor.launching.command_output import printed
        from graphflow.supervisor.launching.debugging import debugged
        from graphflow.supervisor.launching.launch_python import described
        from graphflow.supervisor.launching.probed import read_interfaces
        from graphflow.workspace.project import add_interfaces

        plan = load(self._file, self._given, run=printed, describe=described)
        if self._only:
            plan = plan.only(self._only)
        if self._debug:
            plan = debugged(plan, self._debug)
        add_interfaces(Path(plan.root))
        domain = domain_id(self._domain if self._domain is not None else plan.domain)
        self._starter.begin_probe(plan.classes(), plan.root)
        import graphflow.introspect.graph_view  # noqa: F401 - overlaps with the probe

        interfaces = read_interfaces(self._starter.probed())
        problems = check(plan, interfaces)
        if problems:
            raise GraphFileError(problems)
        types = {s.name: t for s in plan.steps if (t := step_type(s, plan, interfaces))}
        collect_normally()
        return asyncio.run(self._claim_and_supervise(plan, domain, interfaces, types))

    async def _claim_and_supervise(
        self, plan: Plan, domain: int, interfaces: Interfaces, step_types: dict[str, str]
    ) -> int:
        from graphflow.introspect.graph_view import refuse_taken_names
        from graphflow.supervisor import rundir
        from graphflow.supervisor.processes.jobs import first_starts
        from graphflow.transport.config import reaches_out
        from graphflow.transport.rendezvous import establish

        directory = rundir.RunDirectory(domain, plan.name)
        self._lifeline.on_cut(partial(_end_at_once, directory))
        directory.claim()
        try:
            names = [n.name for n in plan.nodes]
            refuse_taken_names(names, domain)
            directory.claim_names(names)  # another graph may be starting at this very moment
            run_id = rundir.new_run_id()
            logs = rundir.open_logs(plan.name, run_id)
            self._log_to(logs / rundir.SUPERVISOR_LOG)
            if self._note >= 0:
                leave_note(self._note, domain, plan.name, logs / rundir.SUPERVISOR_LOG)
            # Before the workers, whose sessions connect to it.
            router = establish()
            if not reaches_out():  # a refused link to another machine would stop the start, so it is tried first
                self._lifeline.on_cut(self._cut_early)
                self._starter.begin(first_starts(plan, domain, logs))
            from graphflow.runtime.context import Context  # from here on all overlaps with the start of the nodes

            context = await Context.open(domain, link=False, checked=True, router=router)
            try:
                context.open_link()
                run = _run_file(plan, run_id, logs, domain, self._guardian)
                return await self._supervise(plan, context, directory, run, interfaces, step_types)
            finally:
                await context.close()
        finally:
            directory.release()

    async def _supervise(
        self,
        plan: Plan,
        context: Context,
        directory: RunDirectory,
        run: GraphRun,
        interfaces: Interfaces,
        step_types: dict[str, str],
    ) -> int:
        import asyncio
        from dataclasses import asdict, replace

        from graphflow.supervisor import rundir
        from graphflow.supervisor.control import server as controlling
        from graphflow.supervisor.control.reachable import keep_reachable
        from graphflow.supervisor.launching.remarks import examine, forward_network_logs
        from graphflow.supervisor.status import mirror
        from graphflow.supervisor.supervisor import Supervisor

        supervisor = Supervisor(plan, context, self._starter, Path(run.logs), step_types)
        control = controlling.ControlServer(supervisor)

        def cut() -> None:
            control.expect_nobody()
            supervisor.begin_stop(now=False, reason=GONE)

        def on_loop(function: Callable[[], object]) -> None:
            with suppress(RuntimeError):  # the loop is closed: the graph has ended
                context.loop.call_soon_threadsafe(function)

        self._lifeline.on_cut(partial(on_loop, cut), partial(on_loop, control.expect_nobody))
        # After `on_cut`: no end of the command falls between the two.
        if self._was_cut:
            cut()
        forward_network_logs(supervisor.note)
        await self._starter.open(Path(run.logs) / rundir.SUPERVISOR_LOG, supervisor.on_event, supervisor.starter_lost)
        run = replace(run, socket=await control.open(directory.socket))
        # Only now: clients find the graph by this file, and then expect its socket to answer.
        directory.write(run)
        stop = partial(supervisor.begin_stop, now=False, reason="SIGTERM")
        signal.signal(signal.SIGTERM, lambda *_: context.loop.call_soon_threadsafe(stop))
        classes = {path: str(interface.place) for path, interface in interfaces.items()}
        self._report({"ok": True, "run": asdict(run), "classes": classes})
        os.close(self._report_pipe)
        self._report_pipe = -1
        background = [
            asyncio.create_task(context.wait_linked()),
            asyncio.create_task(keep_reachable(supervisor, control, directory, run)),
            asyncio.create_task(examine(supervisor, plan, interfaces)),
            asyncio.create_task(mirror(supervisor, context)),
        ]
        if self._is_watching:
            from graphflow.supervisor.processes.watching import watch

            background.append(asyncio.create_task(watch(supervisor, plan, interfaces)))
        await asyncio.sleep(0)  # lets `examine` begin: a graph without processes ends at once
        try:
            code = await supervisor.run()
            await control.wait_followed()
            return code
        finally:
            context.session.leave()
            for task in background:
                task.cancel()
            await control.close()
            await self._starter.close()

    def _cut_early(self) -> None:
        """Record that the command has ended while workers were being started; they are stopped once they can be."""
        self._was_cut = True

    def _log_to(self, path: Path) -> None:
        """Redirect all output to the supervisor's log: the terminal belongs to the command."""
        import logging

        null = os.open(os.devnull, os.O_RDWR)
        out = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        # The lifeline may be the standard input.
        for source, fd in ((null, 1), (out, 2)) if self._note < 0 else ((null, 0), (null, 1), (out, 2)):
            os.dup2(source, fd)
        logging.basicConfig(format="%(asctime)s %(levelname)s %(message)s", level=logging.INFO)


def _run_file(plan: Plan, run_id: str, logs: Path, domain: int, guardian: int) -> GraphRun:
    import hashlib
    import time

    from graphflow.domain import rendezvous_endpoint
    from graphflow.supervisor import rundir

    return rundir.GraphRun(
        run_id=run_id,
        graph=plan.name,
        domain=domain,
        pid=os.getpid(),
        started=rundir.start_time(os.getpid()) or 0.0,
        began=time.time(),
        file=str(Path(plan.file).resolve()),
        socket="",
        logs=str(logs),
        endpoint=rendezvous_endpoint(),
        guardian=guardian,
        guardian_started=(rundir.start_time(guardian) or 0.0) if guardian else 0.0,
        plan_hash=hashlib.sha256(json.dumps(plan.to_json(), sort_keys=True).encode()).hexdigest(),
    )


def _read_line(fd: int) -> bytes:
    """Read one line, and no byte of the next."""
    line = b""
    while not line.endswith(b"\n") and (byte := os.read(fd, 1)):
        line += byte
    return line


if __name__ == "__main__":
    report = os.dup(1)
    sys.exit(_Launch(json.loads(_read_line(0)), report, 0).supervise())
