"""Single keys of a terminal."""

from __future__ import annotations

import asyncio
import os
import pty
import sys
import termios

import pytest

from graphflow.cli.keys import DOWN, RIGHT, UP, key_presses
from tests.until import eventually


def test_keys_of_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each comes by itself, arrows in both of their forms; the terminal is as it was afterwards."""
    ours, theirs = pty.openpty()
    with os.fdopen(theirs, "r+b", buffering=0) as terminal:
        monkeypatch.setattr(sys, "stdin", terminal)
        monkeypatch.setattr(os, "tcgetpgrp", lambda _: os.getpgrp())
        before = termios.tcgetattr(theirs)
        found: list[str] = []

        async def press() -> None:
            with key_presses(found.append) as has_keys:
                assert has_keys
                for text, count in ((" ", 1), ("\x1b[A\x1bOBa", 4), ("b\x1b[C", 6)):
                    os.write(ours, text.encode())
                    await eventually(lambda: len(found) == count)  # noqa: B023

        asyncio.run(press())
        assert found == [" ", UP, DOWN, "a", "b", RIGHT]
        assert termios.tcgetattr(theirs) == before
    os.close(ours)


def test_without_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """There are no keys, nor for what runs in the background of one, which would be stopped for asking."""
    with open(os.devnull) as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        with key_presses(print) as has_keys:
            assert not has_keys
    ours, theirs = pty.openpty()
    with os.fdopen(theirs, "r+b", buffering=0) as terminal:
        monkeypatch.setattr(sys, "stdin", terminal)
        monkeypatch.setattr(os, "tcgetpgrp", lambda _: os.getpgrp() + 1)
        with key_presses(print) as has_keys:
            assert not has_keys
    os.close(ours)
