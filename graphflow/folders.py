"""Folders for state and logs, which outlive a process."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from graphflow.errors import SupervisorError
from graphflow.system import user_id


def state_root() -> Path:
    """Return the folder of the user's state, which is kept from one run to the next."""
    if (given := named("XDG_STATE_HOME")) is not None:
        return given / "graphflow"
    at = home()
    return at / ".local" / "state" / "graphflow" if at is not None else temporary_root("XDG_STATE_HOME") / "state"


def home() -> Path | None:
    """Return the user's home folder; None if neither HOME nor the user database has one, as in some containers."""
    try:
        return Path.home()
    except RuntimeError:
        return None


def temporary_root(variable: str) -> Path:
    """Return the user's private folder in the temporary directory, which is created if needed.

    Args:
        variable: The environment variable to set instead, for the error.

    Raises:
        SupervisorError: The folder cannot be created, or belongs to another user.
    """
    import tempfile  # it imports shutil and every kind of compression; few commands need it

    root = Path(tempfile.gettempdir()) / f"graphflow-{user_id()}"
    make_private(root, variable)
    return root


def make_private(folder: Path, variable: str) -> None:
    """Create a folder that only this user can read. Raises SupervisorError as `temporary_root` does."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        found = folder.lstat()
    except OSError as error:
        raise SupervisorError(f"{folder}: {error.strerror}; set {variable} to a folder you can write to") from None
    if found.st_uid != user_id() or not stat.S_ISDIR(found.st_mode):
        raise SupervisorError(f"{folder} belongs to another user; set {variable} to a folder of your own")


def log_root() -> Path:
    """Return the folder of all logs."""
    given = os.environ.get("ROS_LOG_DIR")
    return Path(given).absolute() if given else state_root()


def newest_logs(graph: str) -> Path:
    """Return the link to the logs of a graph's newest run, which need not exist yet."""
    return log_root() / graph / "latest"


def named(variable: str) -> Path | None:
    """Return a folder from an environment variable; a relative path is ignored, as the specification requires.

    Source: XDG Base Directory Specification.
    """
    given = os.environ.get(variable, "")
    return Path(given) if os.path.isabs(given) else None
