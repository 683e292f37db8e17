"""A real terminal in tmux, whose keys and screen a test controls."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable
from pathlib import Path

from tests.conftest import LIMIT, PROJECT, Machine


class Terminal:
    """A terminal in a tmux server of its own.

    Args:
        socket: Where the server listens.
    """

    def __init__(self, machine: Machine, socket: Path, command: str, size: tuple[int, int] = (100, 30)) -> None:
        self._tmux = ["tmux", "-S", str(socket), "-f", "/dev/null"]
        self._env = {**machine.env, "TERM": "xterm-256color"}
        for name in ("COLUMNS", "LINES", "TMUX"):  # the terminal's size is its own
            self._env.pop(name, None)
        width, height = size
        # The shell stays after the command has ended, so that its last output can be read.
        shell = f"unset TMUX TMUX_PANE; {command}; echo ended with $?; exec sleep 1000"
        self._do("new-session", "-d", "-x", str(width), "-y", str(height), "-c", str(PROJECT), "sh", "-c", shell)
        self._do("set", "-g", "escape-time", "0")

    def _do(self, *words: str) -> str:
        found = subprocess.run([*self._tmux, *words], env=self._env, capture_output=True, text=True, timeout=LIMIT)
        assert found.returncode == 0, found.stderr
        return found.stdout

    @property
    def text(self) -> str:
        """The text on the screen."""
        return self._do("capture-pane", "-p")

    @property
    def styled_text(self) -> str:
        """The text on the screen with its colours, as escape sequences that run on from line to line."""
        return self._do("capture-pane", "-epN")

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows."""
        width, height = self._do("display", "-p", "#{pane_width} #{pane_height}").split()
        return int(width), int(height)

    @property
    def pid(self) -> int:
        """The process in the terminal: the shell's child."""
        shell = int(self._do("display", "-p", "#{pane_pid}"))
        return int(Path(f"/proc/{shell}/task/{shell}/children").read_text().split()[0])

    def press(self, *keys: str) -> None:
        """Press keys, by tmux's names."""
        self._do("send-keys", *keys)

    def type(self, text: str) -> None:
        self._do("send-keys", "-l", text)

    def resize(self, width: int, height: int) -> None:
        self._do("resize-window", "-x", str(width), "-y", str(height))

    def until(self, what: str | Callable[[str], bool], limit: float = LIMIT) -> str:
        """Wait until a text is on the screen; returns the screen."""
        deadline = time.monotonic() + limit
        while True:
            text = self.text
            if what in text if isinstance(what, str) else what(text):
                return text
            if time.monotonic() > deadline:
                raise AssertionError(f"no {what!r} within {limit} s on:\n{text}")
            time.sleep(0.05)

    def hang_up(self) -> None:
        """Close the terminal: its processes get SIGHUP."""
        subprocess.run([*self._tmux, "kill-server"], env=self._env, capture_output=True, timeout=LIMIT, check=False)
