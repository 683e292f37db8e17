"""The causes of the ends of earlier runs, from the supervisors' logs and from what killed runs have left."""

from __future__ import annotations

import json
import time
from contextlib import suppress
from pathlib import Path

from graphflow.domain import domain_id
from graphflow.reading import found_text
from graphflow.supervisor.rundir import SUPERVISOR_LOG, GraphRun, latest_logs, left_over

RECENT = 600.0
"""Seconds for which the end of a graph explains that none is running."""
LOG_BOUND = 100_000_000
"""Size limit in bytes of a supervisor's log that is searched for its end."""


def recent_death() -> str:
    """Return how the newest graph ended, if it was killed a short while ago; empty otherwise.

    Of graphs that have left a run file, only those of this domain count; a log does not tell its graph's domain.
    """
    killed = next((run for _, run in left_over() if run.domain == domain_id()), None)
    logs = Path(killed.logs) if killed is not None else latest_logs(None)
    if logs is None or time.time() - logs.stat().st_mtime > RECENT:
        return ""
    how = how_ended(logs)
    return f"{logs.parent.name}: {how}" if how.startswith("the supervisor, process ") else ""


def guardian_report(run: GraphRun) -> str:
    """Return the guardian's report on the supervisor's end from the log; empty if there is none."""
    begin = f"the supervisor, process {run.pid}, was ended"
    for line in reversed(_supervisor_log(Path(run.logs))):
        if line.startswith(begin):
            return line
    return ""


def how_ended(logs: Path) -> str:
    """Return the cause of a graph's end from its logs; empty if it ended by itself or none was written."""
    for _, run in left_over():
        if run.logs == str(logs):
            return f"the supervisor, process {run.pid}, was killed{', and its guardian' if run.guardian else ''}"
    for line in reversed(_supervisor_log(logs)):
        if line.startswith("the supervisor, process "):
            return line
        entry = line.partition(" INFO ")[2]
        if entry.startswith(('{"event": "error"', '{"event": "stopping"')):
            with suppress(ValueError):  # a full disk has truncated it
                event = json.loads(entry)
                return str(event["message"] if event["event"] == "error" else f"it was stopped ({event['reason']})")
    return ""


def _supervisor_log(logs: Path) -> list[str]:
    try:
        return found_text(logs / SUPERVISOR_LOG, "replace", LOG_BOUND).splitlines()
    except OSError:
        return []
