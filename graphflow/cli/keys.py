"""Single key presses in the terminal, for commands that keep running meanwhile."""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import sys
from collections.abc import Callable, Iterator

UP, DOWN, RIGHT = "\x1b[A", "\x1b[B", "\x1b[C"
_ONE = re.compile(r"\x1b[\[O][A-D]|.", re.DOTALL)
_KEYS = {UP: UP, DOWN: DOWN, RIGHT: RIGHT, "\x1bOA": UP, "\x1bOB": DOWN, "\x1bOC": RIGHT}


@contextlib.contextmanager
def key_presses(handle: Callable[[str], object]) -> Iterator[bool]:
    """Call `handle` with each key pressed inside the block; the context value is whether keys can be read.

    The terminal still turns Ctrl-C into a signal; its settings are restored at the end.
    """
    if not sys.stdin.isatty() or sys.platform == "win32" or os.tcgetpgrp(sys.stdin.fileno()) != os.getpgrp():
        yield False  # reading the terminal from the background would stop the process (SIGTTIN)
        return
    import termios
    import tty

    fd = sys.stdin.fileno()
    before = termios.tcgetattr(fd)
    loop = asyncio.get_running_loop()

    def read() -> None:
        data = os.read(fd, 64).decode(errors="ignore")
        for key in _ONE.findall(data):  # one read may return several keys
            handle(_KEYS.get(key, key))

    tty.setcbreak(fd)
    loop.add_reader(fd, read)
    try:
        yield True
    finally:
        loop.remove_reader(fd)
        termios.tcsetattr(fd, termios.TCSADRAIN, before)
