"""Copying by an external program, if there is one: many terminals ignore the escape sequence that Textual writes."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

LIMIT = 2.0
"""Seconds that the program may take."""


def program() -> tuple[str, ...]:
    """Return the command line of a program that copies its input; empty if there is none."""
    candidates: list[tuple[bool, tuple[str, ...]]] = [
        # With -w tmux also passes the text on to the clipboard of its terminal.
        (bool(os.environ.get("TMUX")), ("tmux", "load-buffer", "-w", "-")),
        (bool(os.environ.get("WAYLAND_DISPLAY")), ("wl-copy",)),
        (bool(os.environ.get("DISPLAY")), ("xclip", "-selection", "clipboard")),
        (bool(os.environ.get("DISPLAY")), ("xsel", "--clipboard", "--input")),
        (sys.platform == "darwin", ("pbcopy",)),
    ]
    return next((words for fits, words in candidates if fits and shutil.which(words[0])), ())


def copy_with(words: tuple[str, ...], text: str) -> str:
    """Copy a text by a program; return the error, empty on success. Blocks for `LIMIT` at most."""
    try:
        # Programs of X11 and Wayland stay alive to serve the selection, so their output must not be awaited.
        done = subprocess.run(
            words,
            input=text.encode(),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=LIMIT,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"{words[0]}: {error}"
    return f"{words[0]} ended with {done.returncode}" if done.returncode else ""
