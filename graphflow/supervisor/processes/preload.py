"""The preload process: it has imported everything a node needs, and forks workers that then start in milliseconds.

It is forked from the supervisor before that opens a Zenoh session, never opens one itself and keeps to one thread,
so that forking it is safe. It is the workers' parent: it reaps them and reports to the supervisor how each ended.

The supervisor sends requests as lines of JSON over a socket pair and gets lines back (their types: `messages`):

    {"do": "probe", "classes": [...], "root": ...}           -> {"event": "probed", "interfaces": {...}}
    {"do": "log", "path": ...}                               (the file for its own errors from now on)
    {"do": "spawn", "process": ..., "job": {...}, "log": ..., "env": {...}}
                                                             -> {"event": "spawned", "process": ..., "pid": ...}
    {"do": "tell", "process": ..., "order": {...}}           (passed on to the worker, over a pipe of its own)

The end of a process is reported as {"event": "exited", "process": ..., "pid": ..., "status": ...}, and a failure of the
preload process itself as {"event": "broken", "trace": ...} before it ends.
"""

from __future__ import annotations

import gc
import json
import os
import selectors
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress
from typing import TYPE_CHECKING, NamedTuple, NoReturn, cast

from graphflow.machines.process import Exit
from graphflow.supervisor.processes import process_tree
from graphflow.supervisor.processes.guardian import GRACE
from graphflow.supervisor.processes.orphaned import LOG_VARIABLE, Orphan
from graphflow.system import end_with_parent

if TYPE_CHECKING:
    from graphflow.supervisor.processes import messages

ORDER_BOUND = 1 << 16
"""Largest order to a worker in bytes: the capacity of an empty pipe (pipe(7))."""
PROBE_LIMIT = 20.0
"""Seconds that importing all classes of a project may take."""
_FRESH = ("PYTHON", "LD_", "MALLOC_")
"""Prefixes of variables that act only on a fresh interpreter."""
_WORKER_COMMAND = (sys.executable, "-P", "-m", "graphflow.supervisor.processes.worker")
_PRELOADED_SERVICES = (
    *(f"rcl_interfaces/srv/{name}" for name in ("GetParameters", "SetParameters", "ListParameters")),
    *(f"rcl_interfaces/srv/{name}" for name in ("DescribeParameters", "GetParameterTypes", "SetParametersAtomically")),
    *(f"rcl_interfaces/srv/{name}" for name in ("GetLoggerLevels", "SetLoggerLevels")),
    "type_description_interfaces/srv/GetTypeDescription",
)
"""The services that every node offers."""


def start(keep: tuple[int, ...]) -> tuple[socket.socket, int, int]:
    """Fork the preload process. Must be called while this process has one thread and no Zenoh session.

    Args:
        keep: Descriptors that the preload process must not keep open.

    Returns:
        The socket to it, the reading end of the workers' status pipe, and its process id.
    """
    mine, its = socket.socketpair()
    status_read, status_write = os.pipe()
    pid = os.fork()
    if pid == 0:
        try:
            mine.close()
            os.close(status_read)
            for fd in keep:
                os.close(fd)
            _Preload(its, status_write).run()
        except BaseException:  # a forked child must not unwind into its parent's code
            _report_failure(its)
        finally:
            os._exit(1)
    its.close()
    os.close(status_write)
    return mine, status_read, pid


def _report_failure(channel: socket.socket) -> None:
    """Report why this process fails: in its log, if it has one yet, and to the supervisor."""
    import traceback

    traceback.print_exc()
    with suppress(OSError):  # the supervisor may have ended
        channel.sendall(json.dumps({"event": "broken", "trace": traceback.format_exc()}).encode() + b"\n")


class _Worker(NamedTuple):
    process: str
    log: str
    """The file for its output, and for that of the processes it starts."""
    orders: int
    """The writing end of the pipe for orders; -1 for a foreign program."""


class _Preload:
    def __init__(self, channel: socket.socket, status: int) -> None:
        self._channel, self._status = channel, status
        self._workers: dict[int, _Worker] = {}
        self._buffer = b""

    def run(self) -> None:
        """Serve requests until the supervisor closes its end."""
        from graphflow.supervisor.processes.worker import STOP_SIGNALS

        process_tree.name_process("gf-preload", "preload process")
        process_tree.adopt_orphans()
        # The command's terminal, or the pipe it writes to, must not be kept open by a graph that outlives the command.
        self._redirect_output(os.devnull)
        self._warm_up()
        wake_read, wake_write = os.pipe()
        for fd in (wake_read, wake_write):
            os.set_blocking(fd, False)
        # SIGCHLD has to wake `select`, which PEP 475 would restart: the handler alone would not.
        signal.set_wakeup_fd(wake_write, warn_on_full_buffer=False)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        # Blocked, not ignored: a signal to a worker just forked waits until the worker can act on it.
        signal.pthread_sigmask(signal.SIG_BLOCK, STOP_SIGNALS)
        selector = selectors.DefaultSelector()
        selector.register(self._channel, selectors.EVENT_READ)
        selector.register(wake_read, selectors.EVENT_READ)
        while True:
            for key, _ in selector.select():
                if key.fileobj is self._channel:
                    self._buffer += self._receive()
                else:
                    os.read(wake_read, 4096)
            self._serve()
            self._reap()

    def _receive(self, flags: int = 0) -> bytes:
        """Return the next bytes from the supervisor; does not return when that has ended."""
        try:
            data = self._channel.recv(65536, flags)
        except ConnectionError:  # it was killed before it had read all answers
            data = b""
        return data or self._end()

    def _warm_up(self) -> None:
        """Import, compile and run once all that every node needs, then tune memory for many forks."""
        os.environ["OPENBLAS_NUM_THREADS"] = "1"  # a second thread would make forking unsafe
        import asyncio  # noqa: F401
        import concurrent.futures.thread  # noqa: F401

        import graphflow.runtime.run
        import graphflow.supervisor.processes.worker
        import graphflow.transport.takeover  # noqa: F401
        from graphflow.msgs import registry
        from graphflow.supervisor.processes.warmup import warm_up
        from graphflow.transport.latched import load_ext
        from graphflow.transport.malloc import keep_freed_memory

        load_ext()  # Zenoh starts no thread before a session is opened
        for name in _PRELOADED_SERVICES:
            registry.service_schema(name)
            registry.hash_of(name)
            registry.interface_class(name)
        for name in ("rcl_interfaces/msg/Log", "rcl_interfaces/msg/ParameterEvent"):
            registry.interface_class(name)
            registry.hash_of(name)
        warm_up()
        keep_freed_memory()
        # Not collected before: that would take longer than the forks, and the imports leave next to no garbage.
        gc.freeze()

    def _serve(self) -> None:
        while b"\n" in self._buffer:
            line, _, self._buffer = self._buffer.partition(b"\n")
            request: messages.PreloadRequest = json.loads(line)
            if request["do"] == "probe":
                self._answer({"event": "probed", "interfaces": self._probe_classes(request)})
            elif request["do"] == "log":
                self._redirect_output(request["path"])
            elif request["do"] == "tell":
                self._pass_on(request)
            elif request["do"] == "spawn":
                self._spawn(request)

    def _redirect_output(self, path: str) -> None:
        out = os.open(path, os.O_RDWR | os.O_APPEND)
        for fd in (0, 1, 2) if path == os.devnull else (2,):
            os.dup2(out, fd)
        os.close(out)

    def _answer(self, event: messages.PreloadEvent) -> None:
        try:
            self._channel.sendall(json.dumps(event).encode() + b"\n")
        except ConnectionError:
            self._end()

    def _probe_classes(self, request: messages.ProbeRequest) -> messages.InterfacesJson:
        """Import classes in a child of their own, which confines the side effects."""
        read, write = os.pipe()
        parent, pid = os.getpid(), os.fork()
        if pid == 0:
            try:
                # A group of its own, for `sweep`.
                os.setpgid(0, 0)
                end_with_parent(parent, signal.SIGKILL)
                self._channel.close()
                os.close(read)
                answer_probe(request, write)
            finally:
                os._exit(0)
        os.close(write)
        data, done = self._read_probe(read)
        os.close(read)
        if not done:
            os.kill(pid, signal.SIGKILL)
        code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        sweep(pid)  # processes that the import has started
        self._end_orphans()
        result = probe_result(data, done, request["classes"], code)
        if any(found.get("needs_numpy") for found in result.values()):
            import numpy  # noqa: F401 - once, for all workers to inherit
        return result

    def _read_probe(self, read: int) -> tuple[bytes, bool]:
        """Read the answer of a probing child; returns it, and whether it was complete in time."""
        data, done = b"", False
        deadline = time.monotonic() + PROBE_LIMIT
        with selectors.DefaultSelector() as selector:
            selector.register(read, selectors.EVENT_READ)
            selector.register(self._channel, selectors.EVENT_READ)  # readable at the supervisor's end: it sends nothing
            while not done and (left := deadline - time.monotonic()) > 0:
                for key, _ in selector.select(left):
                    if key.fileobj is self._channel:
                        self._receive(socket.MSG_PEEK)
                        selector.unregister(self._channel)
                        continue
                    chunk = os.read(read, 65536)
                    data += chunk
                    done = not chunk
        return data, done

    def _pass_on(self, request: messages.OrderRequest) -> None:
        """Pass an order on to its worker; answer for a worker that does not read, stopped perhaps."""
        for worker in self._workers.values():
            if worker.process == request["process"] and worker.orders >= 0:
                error = _write_order(worker.orders, request["order"])
                if not error:
                    return
                self._answer(_refusal(request, error))

    def _spawn(self, request: messages.SpawnRequest) -> None:
        parent = os.getpid()
        orders = write = -1
        try:
            if "command" in request["job"]:
                pid = _spawn_program(request, request["job"])
            else:
                orders, write = os.pipe()
                os.set_blocking(write, False)  # a worker that is stopped must not stop this process
                fresh = any(name.startswith(_FRESH) for name in request["env"])
                pid = self._spawn_fresh(request, orders) if fresh else os.fork()
        except (OSError, ValueError) as error:  # no memory, no free process, an impossible environment
            self._report_unstarted(request["process"], error)
            return
        if pid == 0:
            self._run_worker(request, parent, orders, write)
        if orders >= 0:
            os.close(orders)
        self._workers[pid] = _Worker(request["process"], request["log"], write)
        self._answer({"event": "spawned", "process": request["process"], "pid": pid})

    def _report_unstarted(self, process: str, error: Exception) -> None:
        failed: messages.Failed = {"event": "failed", "process": process, "error": f"cannot be started: {error}"}
        exited: messages.Exited = {"event": "exited", "process": process, "pid": None, "status": 1}
        self._answer(failed)
        self._answer(exited)

    def _run_worker(self, request: messages.SpawnRequest, parent: int, orders: int, write: int) -> NoReturn:
        """Be the worker, in the child."""
        try:
            # Or the supervisor would not see the preload process end as long as this worker lives.
            self._channel.close()
            # A worker sees its preload process end when the last writing end of its orders' pipe is closed.
            for fd in (write, *(worker.orders for worker in self._workers.values() if worker.orders >= 0)):
                os.close(fd)
            self._be_worker(request, parent, orders)
        except BaseException:  # a forked child must not unwind into its parent's code
            import traceback

            traceback.print_exc()
        finally:
            os._exit(70)

    def _be_worker(self, request: messages.SpawnRequest, parent: int, orders: int) -> None:
        from graphflow.supervisor.processes import worker

        worker.become(request["log"], {**request["env"], LOG_VARIABLE: request["log"]}, parent)
        _reseed()
        orphan = Orphan(parent, self._status, orders, request["log"])
        worker.main(cast("messages.WorkerJob", request["job"]), worker.PipeReporter(self._status, orders, orphan))

    def _spawn_fresh(self, request: messages.SpawnRequest, orders: int) -> int:
        """Start a worker in a new interpreter, for an environment that a running one cannot adopt."""
        log = os.open(request["log"], os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        with open(log, "ab") as out:
            child = subprocess.Popen(
                [*_WORKER_COMMAND, str(self._status), str(orders), str(os.getpid())],
                stdin=subprocess.PIPE,
                stdout=out,
                stderr=out,
                env={**os.environ, **request["env"], LOG_VARIABLE: request["log"]},
                pass_fds=[self._status, orders],
                start_new_session=True,
            )
        assert child.stdin is not None
        # Over stdin, since an argument is limited to 128 KiB.
        child.stdin.write(json.dumps(request["job"]).encode())
        child.stdin.close()
        child.returncode = 0  # `_reap` waits for it: its destructor must not
        return child.pid

    def _reap(self) -> None:
        ended = [(pid, self._workers.pop(pid), code) for pid, code in process_tree.reaped() if pid in self._workers]
        for pid, worker, _ in ended:
            sweep(pid)
            if worker.orders >= 0:
                os.close(worker.orders)
        if ended:
            self._end_orphans()
        # After the sweep: the supervisor may start the process again at once, and nothing of the old one must be left.
        for pid, worker, code in ended:
            self._answer({"event": "exited", "process": worker.process, "pid": pid, "status": code})

    def _end_orphans(self) -> None:
        """End processes that ended workers have left in sessions of their own; those of living workers stay."""
        logs = {worker.log for worker in self._workers.values()}
        living = {f"{LOG_VARIABLE}={log}".encode() for log in logs}
        for pid in process_tree.children(os.getpid()):
            is_ours = living & process_tree.environment(pid) or logs & process_tree.files(pid)
            if pid not in self._workers and not is_ours:
                process_tree.kill(pid, signal.SIGKILL)
                process_tree.end_descendants(pid, lambda: None)  # they are not this process's children

    def _end(self) -> NoReturn:
        """End all workers, as the supervisor would have done that is gone now, and exit."""
        for pid in self._workers:
            process_tree.kill_group(pid, signal.SIGTERM)
        deadline = time.monotonic() + GRACE
        while self._workers and time.monotonic() < deadline:
            for pid, _ in process_tree.reaped():
                self._workers.pop(pid, None)
            time.sleep(0.01)
        process_tree.end_descendants(os.getpid(), process_tree.reap_children)
        os._exit(0)


def _spawn_program(request: messages.SpawnRequest, job: messages.ProgramJob) -> int:
    """Start a foreign program with default signal handling: this process blocks some signals and ignores others."""
    parent = os.getpid()

    def prepare() -> None:  # safe as a preexec_fn: this process has one thread
        end_with_parent(parent, signal.SIGTERM)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGCHLD):
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, ())

    log = os.open(request["log"], os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    with open(log, "ab") as out:
        child = subprocess.Popen(
            job["command"],
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=out,
            env={**os.environ, **request["env"], LOG_VARIABLE: request["log"]},
            start_new_session=True,
            preexec_fn=prepare,
        )
    child.returncode = 0  # `_reap` waits for it: its destructor must not
    return child.pid


def answer_probe(request: messages.ProbeRequest, write: int) -> None:
    """Import the classes and write their interfaces, in the probing child."""
    from graphflow.supervisor.launching.classes import add_root, interfaces

    add_root(request["root"])
    null = os.open(os.devnull, os.O_RDWR)
    for fd in (0, 1, 2):  # output of a module during its import is dropped
        os.dup2(null, fd)
    data = json.dumps(interfaces(request["classes"], with_slips=request.get("slips", False))).encode()
    while data:
        data = data[os.write(write, data) :]


def probe_result(data: bytes, done: bool, classes: list[str], code: int) -> messages.InterfacesJson:
    """Read the answer of a probing child, or give the reason for its failure as the problem of each class.

    Args:
        code: Its exit code, negative for a signal.
    """
    if not done:
        why = f"importing it takes longer than {PROBE_LIMIT:.0f} s; do the work in the node, not at import"
        return {path: {"problem": why} for path in classes}
    if code or not data:
        how = f"the process that imported it was ended by {Exit.of_status(code)}"
        return {path: {"problem": how} for path in classes}
    result: messages.InterfacesJson = json.loads(data)
    return result


def _refusal(request: messages.OrderRequest, error: str) -> messages.Obeyed:
    number, process = request["order"]["order"], request["process"]
    return {"event": "obeyed", "process": process, "order": number, "node": "", "number": 0, "error": error}


def _write_order(fd: int, order: messages.Order) -> str:
    """Write an order into a worker's pipe; returns why it could not be; empty if it was."""
    line = json.dumps(order).encode() + b"\n"
    if len(line) > ORDER_BOUND:
        return f"it is {len(line)} bytes long, and a process takes {ORDER_BOUND}"
    return "" if _write_whole(fd, line) else "the process does not read its orders"


def _write_whole(fd: int, line: bytes) -> bool:
    """Write a line into a pipe that is empty, where all of it has room; returns whether it was empty."""
    import fcntl  # not on Windows
    import termios

    unread = fcntl.ioctl(fd, termios.FIONREAD, bytes(4))
    try:
        return not any(unread) and os.write(fd, line) == len(line)
    except BrokenPipeError:
        return False


def sweep(group: int) -> None:
    """End the processes that a worker has left in its process group."""
    try:
        os.killpg(group, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):  # it is empty, or all its processes belong to other users
        return


def _reseed() -> None:
    """Give a forked worker random numbers of its own."""
    import random

    random.seed()
    if "numpy.random" in sys.modules:
        sys.modules["numpy.random"].seed()
