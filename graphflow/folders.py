"""Where graphflow keeps what outlives a process: folders that the environment names."""

from __future__ import annotations

import os
from pathlib import Path


def state_root() -> Path:
    """The folder of what is kept for this user from one run to the next."""
    return (named("XDG_STATE_HOME") or Path.home() / ".local" / "state") / "graphflow"


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
