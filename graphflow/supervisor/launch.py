"""From a graph file to a running supervisor: what happens between `graphflow up` and the first node.

The command forks the supervisor before anything heavy is imported, and the supervisor forks the preload process at
once, so that imports there, reading the file here and waiting in the command overlap. Whatever goes wrong until the
graph runs goes back over a report pipe, as the exit code and text the command ends with.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path
from typing import Any, NoReturn

Report = dict[str, Any]


def launch(file: Path, given: list[str], domain: int | None) -> Report:
    """Start a supervisor for a graph file; returns when the graph is being brought up, or has been refused.

    Args:
        file: The graph file.
        given: `name:=value` arguments.
        domain: See `runtime.context.domain_id`.

    Returns:
        `{"ok": true, "run": {...}, "classes": {...}}` or `{"ok": false, "exit_code": n, "message": text}`.
    """
    read, write = os.pipe()
    sys.stdout.flush()
    sys.stderr.flush()
    pid = os.fork()
    if pid == 0:
        code = 1
        try:
            os.close(read)
            code = _supervise(file, given, domain, write)
        except BaseException:
            import traceback

            text = traceback.format_exc()
            _report(write, ok=False, exit_code=1, message=f"the supervisor failed:\n{text}")
        finally:
            os._exit(code)
    os.close(write)
    data = b""
    while chunk := os.read(read, 65536):
        data += chunk
        if data.endswith(b"\n"):
            break
    os.close(read)
    if not data:
        return {"ok": False, "exit_code": 1, "message": "the supervisor died before the graph was up"}
    report: Report = json.loads(data)
    if not report["ok"]:
        os.waitpid(pid, 0)
    return report


def _report(write: int, **report: Any) -> None:
    try:
        os.write(write, json.dumps(report).encode() + b"\n")
    except OSError:  # the command was killed meanwhile, or has its report already
        return


def _supervise(file: Path, given: list[str], domain: int | None, write: int) -> int:
    os.setsid()
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    from graphflow.supervisor import preload

    channel, status, preload_pid = preload.start(keep=(write,))
    null = os.open(os.devnull, os.O_RDWR)
    os.dup2(null, 0)
    try:
        return _bring_up(file, given, domain, write, channel, status, null)
    finally:
        channel.close()
        os.waitpid(preload_pid, 0)


def _bring_up(
    file: Path, given: list[str], domain: int | None, write: int, channel: Any, status: int, null: int
) -> int:
    from graphflow.errors import GraphFileError, GraphflowError, SupervisorError
    from graphflow.graph.check import check, step_type
    from graphflow.graph.resolve import load
    from graphflow.supervisor.worker import read_interfaces

    def refuse(exit_code: int, error: GraphflowError, count: int = 0) -> int:
        message = str(error)
        if count:
            message += f"\n{count} problem{'s' if count > 1 else ''}, nothing was started"
        _report(write, ok=False, exit_code=exit_code, message=message)
        return exit_code

    try:
        plan = load(file, given)
        channel.sendall(
            json.dumps(
                {"do": "probe", "classes": sorted({n.class_path for n in plan.nodes}), "root": plan.root}
            ).encode()
            + b"\n"
        )
        from graphflow.domain import domain_id

        chosen = domain_id(domain if domain is not None else plan.domain)
        _import_the_rest()
        interfaces = read_interfaces(_read_line(channel)["interfaces"])
        problems = check(plan, interfaces)
        if problems:
            raise GraphFileError(problems)
    except GraphFileError as error:
        return refuse(2, error, len(error.problems))
    except GraphflowError as error:
        return refuse(2, error)
    places = {path: str(i.place) for path, i in interfaces.items()}
    types = {s.name: t for s in plan.steps if (t := step_type(s, plan, interfaces))}
    import asyncio

    try:
        return asyncio.run(_Launch(plan, chosen, places, types, write, channel, status, null).run())
    except SupervisorError as error:
        return refuse(error.exit_code, error)
    except GraphflowError as error:
        return refuse(1, error)


def _import_the_rest() -> None:
    """Imports that overlap with the probe."""
    import asyncio  # noqa: F401

    import graphflow.supervisor.supervisor  # noqa: F401


def _read_line(channel: Any) -> dict[str, Any]:
    data = b""
    while not data.endswith(b"\n"):
        chunk = channel.recv(65536)
        if not chunk:
            _die("the process that imports node classes died")
        data += chunk
    result: dict[str, Any] = json.loads(data)
    return result


def _die(message: str) -> NoReturn:
    from graphflow.errors import SupervisorError

    raise SupervisorError(message)


class _Launch:
    """The last part: claim the run directory, join the network, tell the command, and supervise."""

    def __init__(
        self,
        plan: Any,
        domain: int,
        places: dict[str, str],
        step_types: dict[str, str],
        write: int,
        channel: Any,
        status: int,
        null: int,
    ) -> None:
        self.plan, self.domain, self.places, self.step_types = plan, domain, places, step_types
        self.write, self.channel, self.status, self.null = write, channel, status, null

    async def run(self) -> int:
        """Supervise to the end; returns the exit code.

        Raises:
            SupervisorError, TransportError: The graph cannot be started.
        """
        from graphflow.supervisor import rundir

        directory = rundir.RunDirectory(self.domain, self.plan.name)
        directory.claim()
        try:
            return await self._with_directory(directory)
        finally:
            directory.release()

    async def _with_directory(self, directory: Any) -> int:
        import asyncio

        from graphflow.introspect.view import refuse_taken_names
        from graphflow.runtime.context import Context
        from graphflow.supervisor import rundir
        from graphflow.supervisor.channel import Lines
        from graphflow.supervisor.control import ControlServer
        from graphflow.supervisor.supervisor import Supervisor

        refuse_taken_names([n.name for n in self.plan.nodes], self.domain)
        run_id = rundir.new_run_id()
        logs = rundir.open_logs(self.plan.name, run_id)
        self._log_to(logs / "supervisor.log")
        context = await Context.open(self.domain)
        try:
            preload = Lines(self.channel, lambda e: supervisor.heard(e), lambda: supervisor.preload_lost())
            workers = Lines(self.status, lambda e: supervisor.heard(e), lambda: None)
            preload.send(do="log", path=str(logs / "supervisor.log"))
            supervisor = Supervisor(self.plan, context, preload, logs, self.step_types)
            control = ControlServer(supervisor)
            await control.open(directory.socket)
            run = self._run_file(directory, run_id, logs)
            directory.write(run)
            loop = asyncio.get_running_loop()
            loop.add_signal_handler(signal.SIGTERM, lambda: supervisor.begin_stop(now=False, reason="SIGTERM"))
            _report(self.write, ok=True, run=run.__dict__, classes=self.places)
            os.close(self.write)
            try:
                code = await supervisor.run()
            finally:
                await control.close()
                workers.close()
                preload.close()
            return code
        finally:
            await context.close()

    def _run_file(self, directory: Any, run_id: str, logs: Path) -> Any:
        import hashlib
        import time

        from graphflow.supervisor import rundir
        from graphflow.transport.config import rendezvous_endpoint

        text = json.dumps(self.plan.to_json(), sort_keys=True)
        return rundir.Run(
            run_id=run_id,
            graph=self.plan.name,
            domain=self.domain,
            pid=os.getpid(),
            started=rundir.start_time(os.getpid()) or 0.0,
            began=time.time(),
            file=str(Path(self.plan.file).resolve()),
            socket=str(directory.socket),
            logs=str(logs),
            endpoint=rendezvous_endpoint(),
            plan_hash=hashlib.sha256(text.encode()).hexdigest(),
        )

    def _log_to(self, path: Path) -> None:
        """From here on the supervisor speaks to its log only; the terminal belongs to the command."""
        import logging

        out = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        os.dup2(self.null, 1)
        os.dup2(out, 2)
        logging.basicConfig(format="%(asctime)s %(levelname)s %(message)s", level=logging.INFO)
