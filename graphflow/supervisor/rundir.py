"""A running graph on disk: the run directory, the run file, the logs.

    $XDG_RUNTIME_DIR/graphflow/<domain>/<graph>/       run.json, control.sock      (0700)
    $XDG_RUNTIME_DIR/graphflow/<domain>.<graph>.lock   locked while the graph runs
    $XDG_STATE_HOME/graphflow/<graph>/<run id>/        <node>.log, +supervisor.log; `latest` points to the newest

Without an absolute path in XDG_RUNTIME_DIR a private folder under the temporary directory is used; ROS_LOG_DIR moves
the logs. A graph runs when its run file names a living process with the start time in the file.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
import threading
import time
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

from graphflow.domain import domain_id, rendezvous_endpoint
from graphflow.errors import SupervisorError
from graphflow.folders import log_root, make_private, named, newest_logs, temporary_root
from graphflow.reading import found_text
from graphflow.system import is_portable

SUPERVISOR_LOG = "+supervisor.log"
"""The supervisor's own log; no node can have this name."""
NAMES_PATIENCE = 5.0
"""Seconds that another graph may take to claim its names."""
LOG_NAME_LIMIT = 200
"""Characters of a node's name that its log's name keeps: file systems take 255 bytes in all."""
SOCKET_PATH_LIMIT = 100
"""Longest path of a Unix socket in bytes: below the 104 of macOS with its NUL."""


def runtime_root() -> Path:
    """Return the folder of all this user's run directories; it is created if need be.

    Raises:
        SupervisorError: The folder cannot be created, or belongs to another user.
    """
    given = named("XDG_RUNTIME_DIR")
    if given is None:
        return temporary_root("XDG_RUNTIME_DIR")
    make_private(given / "graphflow", "XDG_RUNTIME_DIR")
    return given / "graphflow"


def new_run_id() -> str:
    """Return a name for a run that sorts by time."""
    return f"{time.strftime('%Y-%m-%d-%H-%M-%S')}-{os.getpid()}"


def open_logs(graph: str, run_id: str) -> Path:
    """Create a run's log folder and point `latest` to it.

    Raises:
        SupervisorError: The folder cannot be created.
    """
    folder = log_root() / graph / run_id
    try:
        folder.mkdir(parents=True, exist_ok=True)
        link = newest_logs(graph)
        # Replaced in one step: there is always a link, and of two runs that begin at once, the last one wins.
        fresh = folder.parent / f".latest-{os.getpid()}"
        fresh.unlink(missing_ok=True)
        if not is_portable():  # symbolic links need a privilege on Windows
            fresh.symlink_to(run_id)
            fresh.replace(link)
    except OSError as error:
        raise SupervisorError(f"{folder}: {error.strerror}; set ROS_LOG_DIR to a folder you can write to") from None
    return folder


def latest_logs(graph: str | None) -> Path | None:
    """Return the log folder of the newest run, of one graph or of any; None if there is none."""
    runs = [f for f in log_root().glob(f"{graph or '*'}/*/") if f != newest_logs(f.parent.name)]
    return max(runs, key=lambda f: f.stat().st_mtime, default=None)


def log_file(folder: Path, node: str) -> Path:
    """Return the log of a node: `/turtle1/follower` logs to `turtle1.follower.log`; a long name is cut and hashed."""
    name = node.strip("/").replace("/", ".")
    if len(name) > LOG_NAME_LIMIT:
        name = f"{name[:LOG_NAME_LIMIT]}-{hashlib.sha256(name.encode()).hexdigest()[:16]}"
    return folder / f"{name}.log"


def start_time(pid: int) -> float | None:
    """Return the start time of a process, in a unit of the system's; None if it is not alive."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text()
        fields = text.rpartition(")")[2].split()  # from field 3 on: field 22 is the start time (proc_pid_stat(5))
        return None if fields[0] == "Z" else float(fields[19])
    except FileNotFoundError:
        if Path("/proc/self/stat").exists():
            return None
    except (OSError, IndexError, ValueError):
        return None
    import psutil

    try:
        return float(psutil.Process(pid).create_time())
    except psutil.Error:
        return None


@dataclass(frozen=True)
class GraphRun:
    """The content of a run file."""

    run_id: str
    graph: str
    domain: int
    pid: int
    started: float
    """`start_time` of the supervisor."""
    began: float
    """Time at which the run began, in seconds since 1970."""
    file: str
    socket: str
    logs: str
    endpoint: str
    plan_hash: str
    guardian: int = 0
    """The process id of the guardian; 0 for none."""
    guardian_started: float = 0.0
    """`start_time` of the guardian."""

    @property
    def is_here(self) -> bool:
        """Whether it runs in the domain and at the endpoint of this process."""
        return self.domain == domain_id() and self.endpoint in ("", rendezvous_endpoint())

    @property
    def is_alive(self) -> bool:
        return start_time(self.pid) == self.started

    def wait_gone(self, timeout: float) -> bool:
        """Wait until supervisor and guardian have ended, so that the graph can be started again; False on timeout."""
        deadline = time.monotonic() + timeout
        while self.is_alive or self.is_guarded:
            if time.monotonic() > deadline:
                return False
            time.sleep(0.01)
        return True

    def renewed(self) -> GraphRun:
        """Return the run with its present guardian, if the run file still exists."""
        now = read_run(runtime_root() / str(self.domain) / self.graph / "run.json")
        return now if now is not None and now.run_id == self.run_id else self

    @property
    def unguarded(self) -> str:
        """The end of the guardian in words; empty while it lives, or if there is none."""
        return f"the guardian, process {self.guardian}, was ended" if self.guardian and not self.is_guarded else ""

    @property
    def guard_again(self) -> str:
        """The end of the guardian, and the next step."""
        return f"{self.unguarded}; to have it guarded again: graphflow up --replace {self.file}"

    @property
    def is_guarded(self) -> bool:
        """Whether the guardian is alive."""
        return bool(self.guardian) and start_time(self.guardian) == self.guardian_started


class RunDirectory:
    """The run directory of one graph in one domain, owned by its supervisor."""

    def __init__(self, domain: int, graph: str) -> None:
        self.path = runtime_root() / str(domain) / graph
        self._lock: int | None = None
        self.changing = threading.RLock()
        """Lock of the thread that changes the directory: the lifeline's thread may end this process meanwhile."""

    def claim(self) -> None:
        """Claim the directory for this process.

        Raises:
            SupervisorError: The graph is already running, or the directory cannot be created.
        """
        with self.changing:
            self._claim()

    def _claim(self) -> None:
        # Next to the directory, and never removed: a lock on a removed file would lock nobody else out.
        lock = _lock_of(self.path)
        try:
            self._lock = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        except OSError as error:
            raise SupervisorError(f"{lock}: {error.strerror}") from None
        try:
            lock_file(self._lock)
        except OSError:
            os.close(self._lock)
            self._lock = None
            run = read_run(self.path / "run.json")
            since = f" since {time.strftime('%H:%M:%S', time.localtime(run.began))}, process {run.pid}" if run else ""
            raise SupervisorError(
                f"graph {self.path.name} is already running (domain {self.path.parent.name}{since}); "
                f"stop it with: graphflow down --graph {self.path.name}"
            ) from None
        try:
            self.path.mkdir(mode=0o700, parents=True, exist_ok=True)
        except OSError as error:
            raise SupervisorError(f"{self.path}: {error.strerror}") from None

    def claim_names(self, names: Iterable[str]) -> None:
        """Claim the names of the graph's nodes, before their tokens are known to the network.

        Raises:
            SupervisorError: Another graph of this user, domain and rendezvous has claimed some of them.
        """
        with self.changing:
            self._claim_names(names)

    def _claim_names(self, names: Iterable[str]) -> None:
        root, endpoint = self.path.parents[1], rendezvous_endpoint()
        guard = os.open(root / "names.lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        try:
            _lock_soon(guard, root / "names.lock")
            for file in self.path.parent.glob("*/names"):
                claimed = found_text(file).split("\n") if file.parent != self.path else []
                taken = sorted(set(names).intersection(claimed)) if claimed[:1] == [endpoint] else []
                # A graph that was killed has left its names behind, but no lock.
                if taken and is_locked(_lock_of(file.parent)):
                    raise SupervisorError(
                        f"already in domain {self.path.parent.name}: {', '.join(taken)} (graph {file.parent.name}). "
                        f"Stop it with: graphflow down --graph {file.parent.name}"
                    )
            (self.path / "names").write_text("\n".join([endpoint, *names]), encoding="utf-8")
        except OSError as error:
            raise SupervisorError(f"{error.filename or root}: {error.strerror}") from None
        finally:
            os.close(guard)

    def is_there(self, run: GraphRun) -> bool:
        """Return whether verbs still find the graph: a logout removes the directory."""
        return read_run(self.path / "run.json") == run

    def restore(self) -> None:
        """Create the directory again. Raises SupervisorError if that fails."""
        try:
            self.path.mkdir(mode=0o700, parents=True, exist_ok=True)
        except OSError as error:
            raise SupervisorError(f"{self.path}: {error.strerror}") from None
        with self.changing:
            # The locked file may be gone like the directory, and a lock on it would lock nobody else out.
            if self._lock is not None:
                os.close(self._lock)
                self._lock = None
            self.claim()

    @property
    def socket(self) -> Path:
        """The path of the control socket: inside, or elsewhere if that path is too long for a socket."""
        inside = self.path / "control.sock"
        if len(os.fsencode(inside)) <= SOCKET_PATH_LIMIT:
            return inside
        digest = hashlib.sha256(os.fsencode(inside)).hexdigest()[:16]
        return temporary_root("XDG_RUNTIME_DIR") / f"{digest}.sock"

    def write(self, run: GraphRun) -> None:
        """Write the run file atomically."""
        fresh = self.path / "run.json.new"
        with self.changing:
            fresh.write_text(json.dumps(asdict(run), indent=1))
            fresh.replace(self.path / "run.json")

    def release(self) -> None:
        """Remove the files and the directory, and unlock it, if it was claimed."""
        with self.changing:
            if self._lock is not None:
                self._remove()
                os.close(self._lock)
                self._lock = None

    def _remove(self) -> None:
        for name in ("run.json", "run.json.new", "names", "control.sock"):
            (self.path / name).unlink(missing_ok=True)
        self.socket.unlink(missing_ok=True)
        for folder in (self.path, self.path.parent):
            try:
                folder.rmdir()
            except OSError:  # another graph of the domain is using it
                break


def _lock_of(directory: Path) -> Path:
    return directory.parents[1] / f"{directory.parent.name}.{directory.name}.lock"


def is_locked(file: Path) -> bool:
    """Return whether a living process has locked a file."""
    try:
        fd = os.open(file, os.O_RDWR | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        lock_file(fd)
    except OSError:
        return True
    finally:
        os.close(fd)
    return False


def _lock_soon(fd: int, file: Path) -> None:
    """Lock a file that other processes lock only for moments."""
    deadline = time.monotonic() + NAMES_PATIENCE
    while True:
        try:
            lock_file(fd)
        except OSError:
            if time.monotonic() > deadline:
                raise SupervisorError(f"{file} has been locked for {NAMES_PATIENCE:g} s; is a graph stopped?") from None
            time.sleep(0.01)
        else:
            return


def lock_file(fd: int) -> None:
    """Lock a file until its descriptor is closed; raises OSError if another process has locked it."""
    if sys.platform == "win32":
        import msvcrt

        msvcrt.locking(fd, msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)


def read_run(path: Path) -> GraphRun | None:
    """Read a run file; None if it is missing or not a run file."""
    try:
        return GraphRun(**json.loads(found_text(path)))
    except (OSError, ValueError, TypeError):
        return None


def running() -> list[GraphRun]:
    """Return the running graphs of this user, sorted by name."""
    found = [read_run(path) for path in sorted(runtime_root().glob("*/*/run.json"))]
    return sorted((r for r in found if r is not None and r.is_alive), key=lambda r: (r.graph, r.domain))


def left_over() -> list[tuple[Path, GraphRun]]:
    """Return the run directories, with the runs, of graphs that were killed together with their guardians."""
    found = [(path.parent, read_run(path)) for path in sorted(runtime_root().glob("*/*/run.json"))]
    return [(folder, run) for folder, run in found if run is not None and not run.is_alive and not run.is_guarded]
