"""Filter log lines by level and time: `[WARN] [1795223522.100807190] [talker]: text`."""

from __future__ import annotations

import re
import time
from pathlib import Path

from graphflow.errors import UsageFault

_HEAD = re.compile(r"\[(DEBUG|INFO|WARN|ERROR|FATAL)\] \[(\d{1,12}\.\d{1,9})\] ")
_ORDER = ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")
_AGO = re.compile(r"(\d{1,6}(?:\.\d{1,3})?)\s*(s|m|h|d)?\Z")
_CLOCK = re.compile(r"(\d{1,2}):(\d{2})(?::(\d{2}))?\Z")
_UNITS = {None: 1, "s": 1, "m": 60, "h": 3600, "d": 86400}


class Chosen:
    """A filter of lines. A line without a head, such as one of a traceback, belongs to the message before it.

    Args:
        level: The lowest level; None for any.
        since: The earliest time, as `time_of` reads it; None for any.

    Raises:
        UsageFault: `since` is not a time.
    """

    def __init__(self, level: str | None, since: str | None) -> None:
        self._least = _ORDER.index(level.upper()) if level else 0
        self._since = time_of(since, time.time()) if since else 0.0
        self._continues: dict[Path, bool] = {}

    def of(self, file: Path, lines: list[str]) -> list[str]:
        """Filter the next lines of a file."""
        found = []
        is_wanted = self._continues.get(file, self._least == 0 and self._since == 0.0)
        for line in lines:
            head = _HEAD.match(line)
            if head:
                is_wanted = _ORDER.index(head[1]) >= self._least and float(head[2]) >= self._since
            elif line.startswith("[supervisor] "):
                is_wanted = True
            if is_wanted:
                found.append(line)
        self._continues[file] = is_wanted
        return found


def record(node: str, line: str) -> dict[str, object]:
    """Parse a log line into its level, time, logger and text; only the text if it has no head."""
    head = _HEAD.match(line)
    if head is None:
        return {"event": "log", "node": node, "level": None, "stamp_ns": None, "logger": None, "text": line}
    seconds, _, fraction = head[2].partition(".")
    logger, _, text = line[head.end() :].partition("]: ")
    stamp_ns = int(seconds) * 10**9 + int(fraction.ljust(9, "0"))
    found = {"level": head[1], "stamp_ns": stamp_ns, "logger": logger.removeprefix("["), "text": text}
    return {"event": "log", "node": node, **found}


def time_of(text: str, now: float) -> float:
    """Convert `5m` (ago), or `14:05` today or yesterday, whichever was last, to seconds since 1970.

    Raises:
        UsageFault: `text` is neither.
    """
    ago = _AGO.match(text.strip())
    if ago:
        return now - float(ago[1]) * _UNITS[ago[2]]
    clock = _CLOCK.match(text.strip())
    if clock and int(clock[1]) < 24 and int(clock[2]) < 60 and int(clock[3] or 0) < 60:
        today = time.localtime(now)
        at = (today.tm_year, today.tm_mon, today.tm_mday, int(clock[1]), int(clock[2]), int(clock[3] or 0), 0, 0, -1)
        found = time.mktime(at)
        return found if found <= now else found - 86400
    raise UsageFault(f"--since {text}: write a duration such as 30s, 5m or 2h, or a time of day such as 14:05")
