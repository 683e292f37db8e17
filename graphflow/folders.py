"""Where graphflow keeps what outlives a process: folders that the environment names."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from graphflow.errors import SupervisorError
from graphflow.system import user_id


def state_root() -> Path:
    """The folder of what is kept for this user from one run to the next."""
    if (given := named("XDG_STATE_HOME")) is not None:
        return given / "graphflow"
    at = home()
    return at / ".local" / "state" / "graphflow" if at is not None else temporary_root("XDG_STATE_HOME") / "state"


def home() -> Path | None:
    """The user's home; None where neither HOME nor the system's list of users has one, as in containers."""
    try:
        return Path.home()
    except RuntimeError:
        return None


def temporary_root(variable: str) -> Path:
    """A private folder of this user's under the temporary directory, made if need be.

    Args:
        variable: What to set in its place.

    Raises:
        SupervisorError: The folder cannot be made, or belongs to another user.
    """
    import tempfile  # with all kinds of compression, which few commands need

    root = Path(tempfile.gettempdir()) / f"graphflow-{user_id()}"
    make_private(root, variable)
    return root


def make_private(folder: Path, variable: str) -> None:
    """Make a folder that only this user can read. Raises SupervisorError: As for `temporary_root`."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        found = folder.lstat()
    except OSError as error:
        raise SupervisorError(f"{folder}: {error.strerror}; set {variable} to a folder you can write to") from None
    if found.st_uid != user_id() or not stat.S_ISDIR(found.st_mode):
        raise SupervisorError(f"{folder} belongs to another user; set {variable} to a folder of your own")


def log_root() -> Path:
    """The folder of all logs."""
    given = os.environ.get("ROS_LOG_DIR")
    return Path(given).absolute() if given else state_root()


def newest_logs(graph: str) -> Path:
    """The link to the logs of a graph's newest run, which need not be there yet."""
    return log_root() / graph / "latest"


def named(variable: str) -> Path | None:
    """A folder that the environment names; a relative one would be another in each place, and counts as none.

    Source: XDG Base Directory Specification.
    """
    given = os.environ.get(variable, "")
    return Path(given) if os.path.isabs(given) else None
