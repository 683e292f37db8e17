"""From a graph file to a running supervisor: what happens between `graphflow up` and the first node.

The command forks the supervisor before anything heavy is imported, and the supervisor forks the preload process at
once, so that imports there, reading the file here and waiting in the command overlap. Whatever goes wrong before the
graph runs goes back over a report pipe, as the exit code and text the command ends with.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graphflow.system import detached, is_portable

if TYPE_CHECKING:
    from graphflow.graph.check import Interfaces
    from graphflow.graph.plan import Plan
    from graphflow.runtime.context import Context
    from graphflow.supervisor.control import ControlServer
    from graphflow.supervisor.rundir import GraphRun, RunDirectory
    from graphflow.supervisor.starter import Starter
    from graphflow.supervisor.supervisor import Supervisor

Report = dict[str, Any]

REACHABLE_EVERY = 2.0
"""Seconds between two looks whether the run directory is still there."""


def launch(file: Path, given: list[str], domain: int | None, *, attached: bool) -> Report:
    """Start a supervisor for a graph file; returns when the graph is being brought up, or has been refused.

    Args:
        file: The graph file.
        given: `name:=value` arguments.
        domain: See `domain.domain_id`.
        attached: Whether the graph must go down when the command that follows it has gone.

    Returns:
        `{"ok": true, "run": {...}, "classes": {...}}` or `{"ok": false, "exit_code": n, "message": text}`.
    """
    begin = _begin_portable if is_portable() else _begin_forked
    pid, read, reap = begin({"file": str(file), "given": given, "domain": domain, "attached": attached})
    data = b""
    try:
        while not data.endswith(b"\n") and (chunk := os.read(read, 65536)):
            data += chunk
    except KeyboardInterrupt:
        os.kill(pid, signal.SIGTERM)
        raise
    finally:
        os.close(read)
    if not data:
        return {"ok": False, "exit_code": 1, "message": "the supervisor died before the graph was up"}
    report: Report = json.loads(data)
    if not report["ok"]:
        reap()
    return report


_Begun = tuple[int, int, Callable[[], object]]
"""The supervisor's process id, the descriptor its report comes from, and a function that waits for its end."""


def _begin_forked(job: dict[str, Any]) -> _Begun:
    read, write = os.pipe()
    sys.stdout.flush()
    sys.stderr.flush()
    pid = os.fork()
    if pid == 0:
        code = 1
        try:
            os.close(read)
            os.setsid()
            code = _Launch(job, write).supervise()
        finally:
            os._exit(code)
    os.close(write)
    return pid, read, lambda: os.waitpid(pid, 0)


def _begin_portable(job: dict[str, Any]) -> _Begun:
    import subprocess

    command = [sys.executable, "-P", "-m", "graphflow.supervisor.launch"]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, **detached())
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(json.dumps(job).encode())
    process.stdin.close()
    return process.pid, os.dup(process.stdout.fileno()), process.wait


class _Launch:
    """The supervisor's process, from the fork to the end of the graph."""

    def __init__(self, job: dict[str, Any], report: int) -> None:
        self._file, self._given, self._domain = Path(job["file"]), job["given"], job["domain"]
        self._attached = job["attached"]
        self._report_pipe = report
        self._starter: Starter

    def supervise(self) -> int:
        """Bring the graph up and supervise it to its end; returns the exit code."""
        from graphflow.errors import GraphFileError, GraphflowError, SupervisorError

        for name in ("SIGINT", "SIGHUP"):
            if hasattr(signal, name):
                signal.signal(getattr(signal, name), signal.SIG_IGN)
        starter = None
        try:
            starter = self._starter = _make_starter(keep=(self._report_pipe,))
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

    def _report(self, **report: Any) -> None:
        if self._report_pipe < 0:  # the command already knows that the graph is up; what comes now goes to the log
            sys.stderr.write(f"{report}\n")
            return
        try:
            os.write(self._report_pipe, json.dumps(report).encode() + b"\n")
        except OSError:  # the command was killed meanwhile
            return

    def _refuse(self, exit_code: int, message: str) -> int:
        self._report(ok=False, exit_code=exit_code, message=message)
        return exit_code

    def _run(self) -> int:
        import asyncio

        from graphflow.domain import domain_id
        from graphflow.errors import GraphFileError
        from graphflow.graph.check import check, step_type
        from graphflow.graph.project import add_interfaces
        from graphflow.graph.resolve import load
        from graphflow.supervisor.classes import read_interfaces

        plan = load(self._file, self._given)
        add_interfaces(Path(plan.root))
        domain = domain_id(self._domain if self._domain is not None else plan.domain)
        self._starter.begin_probe(sorted({n.class_path for n in plan.nodes}), plan.root)
        import graphflow.supervisor.supervisor  # noqa: F401 - overlaps with the probe

        interfaces = read_interfaces(self._starter.probed())
        problems = check(plan, interfaces)
        if problems:
            raise GraphFileError(problems)
        types = {s.name: t for s in plan.steps if (t := step_type(s, plan, interfaces))}
        return asyncio.run(self._claim_and_supervise(plan, domain, interfaces, types))

    async def _claim_and_supervise(
        self, plan: Plan, domain: int, interfaces: Interfaces, step_types: dict[str, str]
    ) -> int:
        from graphflow.introspect.view import refuse_taken_names
        from graphflow.runtime.context import Context
        from graphflow.supervisor import rundir

        directory = rundir.RunDirectory(domain, plan.name)
        directory.claim()
        try:
            names = [n.name for n in plan.nodes]
            refuse_taken_names(names, domain)
            directory.claim_names(names)  # another graph may be starting at this very moment
            run_id = rundir.new_run_id()
            logs = rundir.open_logs(plan.name, run_id)
            _log_to(logs / rundir.SUPERVISOR_LOG)
            context = await Context.open(domain, link=False)
            try:
                context.open_link()
                run = _run_file(plan, run_id, logs, domain)
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
        from dataclasses import replace

        from graphflow.supervisor import control as controlling
        from graphflow.supervisor import rundir
        from graphflow.supervisor.supervisor import Supervisor

        supervisor = Supervisor(plan, context, self._starter, Path(run.logs), step_types)
        _tell_notes(supervisor.note)
        await self._starter.open(Path(run.logs) / rundir.SUPERVISOR_LOG, supervisor.heard, supervisor.starter_lost)
        control = controlling.ControlServer(supervisor)
        run = replace(run, socket=await control.open(directory.socket))
        directory.write(run)
        stop = partial(supervisor.begin_stop, now=False, reason="SIGTERM")
        signal.signal(signal.SIGTERM, lambda *_: context.loop.call_soon_threadsafe(stop))
        if self._attached:
            control.expect_lifeline()
        classes = {path: str(interface.place) for path, interface in interfaces.items()}
        self._report(ok=True, run=run.__dict__, classes=classes)
        os.close(self._report_pipe)
        self._report_pipe = -1
        linked = asyncio.create_task(context.wait_linked())
        kept = asyncio.create_task(_keep_reachable(supervisor, control, directory, run))
        warned = asyncio.create_task(_warn(supervisor, plan, interfaces))
        try:
            code = await supervisor.run()
            await control.wait_followed()
            return code
        finally:
            linked.cancel()
            kept.cancel()
            warned.cancel()
            await control.close()
            await self._starter.close()


async def _keep_reachable(
    supervisor: Supervisor, control: ControlServer, directory: RunDirectory, run: GraphRun
) -> None:
    """Make the run directory again when it is taken away, as at a logout; else stop, for no verb could do it."""
    import asyncio

    from graphflow.errors import SupervisorError

    while True:
        await asyncio.sleep(REACHABLE_EVERY)
        if directory.is_there(run):
            continue
        try:
            directory.restore()
            if not is_portable():
                await control.open(directory.socket)
            directory.write(run)
        except (OSError, SupervisorError) as error:
            supervisor.begin_stop(now=False, reason=f"its run directory was taken away: {error}")
            return
        supervisor.note("the run directory was taken away, and was made again")


async def _warn(supervisor: Supervisor, plan: Plan, interfaces: Interfaces) -> None:
    """Once the graph is up, report the deadlocks that its source shows."""
    import asyncio

    from graphflow.graph.static import findings, warnings

    await supervisor.up.wait()
    if plan.deadlock != "off":
        ways = await asyncio.to_thread(findings, plan, interfaces)
        for text in warnings(ways, plan.file):
            supervisor.note(text)


def _run_file(plan: Plan, run_id: str, logs: Path, domain: int) -> GraphRun:
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
        plan_hash=hashlib.sha256(json.dumps(plan.to_json(), sort_keys=True).encode()).hexdigest(),
    )


def _log_to(path: Path) -> None:
    """From here on the supervisor writes only to its log; the terminal belongs to the command."""
    import logging

    null = os.open(os.devnull, os.O_RDWR)
    out = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    for source, fd in ((null, 0), (null, 1), (out, 2)):
        os.dup2(source, fd)
    logging.basicConfig(format="%(asctime)s %(levelname)s %(message)s", level=logging.INFO)


def _tell_notes(note: Callable[[str], None]) -> None:
    """Pass what the supervisor's process learns about the network on to the doors that follow the graph."""
    import logging

    class Notes(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            note(record.getMessage())

    for name in ("graphflow.link", "graphflow.rendezvous"):
        logging.getLogger(name).addHandler(Notes(logging.INFO))


def _make_starter(keep: tuple[int, ...]) -> Starter:
    """A starter of the kind that this system uses. Must be made while this process has one thread.

    Args:
        keep: Descriptors that workers must not inherit.
    """
    if is_portable():
        from graphflow.supervisor.spawning import SpawningStarter

        return SpawningStarter()
    from graphflow.supervisor.forking import ForkingStarter

    return ForkingStarter(keep)


if __name__ == "__main__":
    report = os.dup(1)
    sys.exit(_Launch(json.load(sys.stdin), report).supervise())
