"""Slow terminals: frames are skipped, keys have a prompt effect, and the whole screen is drawn in the end."""

from __future__ import annotations

import fcntl
import os
import pty
import queue
import re
import select
import signal
import struct
import sys
import termios
import time
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from graphflow.tui.tty.pacing import LATE, Pacing, waiting
from tests.cases import slow
from tests.conftest import LIMIT, PROJECT, Machine

RATE = 20_000
"""Bytes per second that the terminal reads."""
ESCAPES = re.compile(rb"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)?|\x1b.")


def driver(*writes: str) -> SimpleNamespace:
    """A driver with pending writes."""
    waits: queue.Queue[str] = queue.Queue()
    for text in writes:
        waits.put(text)
    return SimpleNamespace(_writer_thread=SimpleNamespace(_queue=waits))


def test_frames_are_left_out_while_one_waits() -> None:
    """Skipping goes on until a full redraw, since the terminal's screen is not known."""
    now = [0.0]
    pacing, behind = Pacing(lambda: now[0]), driver("frame")
    assert pacing.admits(driver())
    assert not pacing.catches_up(driver())
    assert pacing.admits(behind)  # the writing thread has not run yet
    now[0] += LATE
    assert not pacing.admits(behind)
    assert not pacing.catches_up(behind)
    assert not pacing.admits(driver())
    assert pacing.left_out == 2
    assert pacing.catches_up(driver())
    assert pacing.admits(driver())


def test_drivers_that_tell_nothing() -> None:
    """Without a writing thread, as in a browser, every frame is written."""
    assert waiting(object()) == 0
    assert Pacing().admits(None)


class SlowTerminal:
    """A pty that is read at the rate of a slow link."""

    def __init__(self, machine: Machine, words: list[str]) -> None:
        self.pid, self._fd = pty.fork()
        if self.pid == 0:
            os.chdir(PROJECT)
            os.execvpe(words[0], words, {**machine.env, "TERM": "xterm-256color", "COLORTERM": "truecolor"})
        fcntl.ioctl(self._fd, termios.TIOCSWINSZ, struct.pack("HHHH", 36, 120, 0, 0))

    def press(self, key: bytes) -> None:
        os.write(self._fd, key)

    def until(self, what: bytes) -> int:
        """Read until a text has come; return the bytes before it."""
        began, read, count = time.monotonic(), b"", 0
        while what not in ESCAPES.sub(b"", read):
            assert time.monotonic() - began < LIMIT, read[-2000:]
            allowed = int((time.monotonic() - began) * RATE) - count
            if allowed < 200 or not select.select([self._fd], [], [], 0.0)[0]:
                time.sleep(0.01)
                continue
            data = os.read(self._fd, allowed)
            count += len(data)
            read += data
        return count

    def close(self) -> None:
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)
        os.close(self._fd)


@pytest.fixture
def terminal(machine: Machine) -> Iterator[SlowTerminal]:
    machine.run("up", "-d", "turtlesim")
    opened = SlowTerminal(machine, [sys.executable, "-m", "graphflow", "attach"])
    yield opened
    opened.close()
    machine.run("down")


@slow
@pytest.mark.real
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pty")
def test_a_link_of_20_kilobytes_a_second(terminal: SlowTerminal) -> None:
    """While turtles move, the effect of a key is visible within a few frames, not after thirty."""
    terminal.until(b"leave")
    terminal.until(b"turtle2")
    for _ in range(2):
        terminal.press(b"\x1b[11~")  # f1
        assert terminal.until(b"type to find") < 100_000
        terminal.press(b"\x1b")
        assert terminal.until(b"leave") < 100_000
