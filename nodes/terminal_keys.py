"""Keyboard input: decoding of a terminal's bytes, and access to the terminal.

A terminal sends a letter as one byte and an arrow as several, `ESC [ A`, which may arrive in pieces. Normally it sends
nothing before Return is pressed; `keyboard` changes that for the length of a block. The event loop reports available
input, so nothing blocks or polls.
"""

from __future__ import annotations

import asyncio
import os
import re
import termios
import tty
from collections.abc import Iterator
from contextlib import contextmanager, suppress

HANGUP = "hangup"
"""The last item of the queue: the terminal has closed."""
_NAMES = {b"A": "up", b"B": "down", b"C": "right", b"D": "left"}
# ECMA-48, 5.4: a control sequence is ESC [, parameters, intermediates and a final byte. ESC O is what a keypad
# in application mode sends instead.
_SEQUENCE = re.compile(rb"\x1b(?:\[[0-?]*[ -/]*|O)([@-~])")
_BEGUN = re.compile(rb"\x1b(?:\[[0-?]*[ -/]*|O)?\Z")


def decode_keys(pressed: bytes) -> tuple[list[str], bytes]:
    """Decode keys from a terminal's bytes.

    Returns:
        The keys, `up`, `down`, `left`, `right`, `escape` or the character, without unnamed ones; and the bytes of an
        incomplete key, to be prepended to the next ones.
    """
    keys: list[str] = []
    at = 0
    while at < len(pressed):
        if sequence := _SEQUENCE.match(pressed, at):
            keys += [_NAMES[sequence[1]]] if sequence[1] in _NAMES else []
            at = sequence.end()
        elif _BEGUN.match(pressed, at):
            break
        else:
            keys += ["escape"] if pressed[at] == 0x1B else [chr(pressed[at])] if pressed[at] < 0x80 else []
            at += 1
    return keys, pressed[at:]


@contextmanager
def keyboard(terminal: int) -> Iterator[asyncio.Queue[str]]:
    """Read a terminal's keys, each at once and without echo, for the length of the block.

    The terminal's settings are restored however the block ends. Ctrl-C still interrupts.

    Args:
        terminal: The terminal's file descriptor.

    Raises:
        termios.error: `terminal` is not a terminal.
    """
    keys: asyncio.Queue[str] = asyncio.Queue()
    loop = asyncio.get_running_loop()
    begun = b""

    def readable() -> None:
        nonlocal begun
        try:
            received = os.read(terminal, 1024)
        except OSError:
            received = b""
        if not received:
            loop.remove_reader(terminal)
            keys.put_nowait(HANGUP)
        pressed, begun = decode_keys(begun + received)
        for key in pressed:
            keys.put_nowait(key)

    before = termios.tcgetattr(terminal)
    try:
        tty.setcbreak(terminal)
        loop.add_reader(terminal, readable)
        yield keys
    finally:
        loop.remove_reader(terminal)
        with suppress(termios.error):  # a closed terminal needs no restoring
            termios.tcsetattr(terminal, termios.TCSADRAIN, before)
