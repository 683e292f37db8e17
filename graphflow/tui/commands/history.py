"""The history of commands, typed or sent by forms, that all consoles of a user share."""

from __future__ import annotations

import logging
import os
import shlex
import tempfile
from pathlib import Path
from typing import Any

from graphflow.errors import GraphflowError
from graphflow.folders import state_root
from graphflow.markup.source import parse_value
from graphflow.reading import found_text

KEPT = 1000
"""Commands kept; the file may grow to four times as many before it is trimmed."""
LONGEST = 2_000
"""Maximum characters of a command; longer ones are not kept."""

logger = logging.getLogger("graphflow.console")


def history_file() -> Path:
    """Return the path of this user's history."""
    return state_root() / ".history"


def without_program(line: str) -> str:
    """Return a command without the program's name; ROS users type `ros2`."""
    line = line.strip()
    first, _, rest = line.partition(" ")
    return rest.strip() if first in ("graphflow", "gf", "ros2") else line


class History:
    """Commands without the program's name, oldest first.

    Several consoles may share a file: each appends to it, and reads all of it at start.

    Args:
        file: The file; None to keep the history in memory only.
    """

    def __init__(self, file: Path | None = None) -> None:
        self._file = file
        self._lines: list[str] | None = None

    @property
    def lines(self) -> list[str]:
        """All commands, read from the file at the first access."""
        if self._lines is None:
            self._lines = self._read()
        return self._lines

    def add(self, line: str) -> None:
        """Append a command unless it repeats the previous one."""
        line = without_program(line)
        if not line or "\n" in line or len(line) > LONGEST or line == (self.lines or [""])[-1]:
            return
        self.lines.append(line)
        del self.lines[:-KEPT]
        if self._file is None:
            return
        try:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            # Appended in one write, so that lines of several consoles do not mix; private, as commands may be.
            descriptor = os.open(self._file, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
            with open(descriptor, "a", encoding="utf-8") as file:
                file.write(f"{line}\n")
        except OSError as error:
            self._file = None
            logger.warning("commands are forgotten with this console: %s", error)

    def requests(self, *words: str) -> list[dict[str, Any]]:
        """Return the YAML mappings at the end of commands that begin with these words: `service call /spawn TYPE`."""
        found: list[dict[str, Any]] = []
        for line in self.lines:
            if not line.startswith(words[0]):
                continue
            try:
                *before, values = shlex.split(line)
                value = parse_value(values) if before == [*words] else None
            except (ValueError, GraphflowError):  # a typo in a command typed by hand
                continue
            if isinstance(value, dict):
                found.append(value)
        return found

    def _read(self) -> list[str]:
        if self._file is None:
            return []
        try:
            lines = found_text(self._file, errors="replace").split("\n")[:-1]
            if len(lines) > 4 * KEPT:
                self._cut(lines[-KEPT:])
        except FileNotFoundError:
            return []
        except OSError as error:
            logger.warning("commands of earlier consoles cannot be read: %s", error)
            return []
        return lines[-KEPT:]

    def _cut(self, lines: list[str]) -> None:
        assert self._file is not None
        with tempfile.NamedTemporaryFile("w", dir=self._file.parent, delete=False, encoding="utf-8") as fresh:
            fresh.writelines(f"{line}\n" for line in lines)
        os.replace(fresh.name, self._file)
