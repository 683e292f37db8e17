"""Endless loops that catch the KeyboardInterrupt of Ctrl-C with a bare `except:`, so that the program goes on.

ROS 2 says nothing of them, and further signals are caught as well. Only a loop without `break` and `return` counts: a
program may clean up for as long as it likes.
"""

from __future__ import annotations

import _thread
import ast
import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from types import CodeType, FrameType

from graphflow.analysis.syntax import first_line, last_name, nodes_in, syntax_of, walk
from graphflow.analysis.user_code import is_users, short_place

LOOK_AFTER = 2.0
"""Seconds from the signal to the look at the main thread."""
_stuck: set[CodeType] = set()
"""Functions with such a loop, which were reported."""


def watch() -> None:
    """Look at the main thread after a while, and tell of such a loop. Callable in a signal handler."""
    _thread.start_new_thread(_look, ())


def end_if_stuck(frame: FrameType | None) -> None:
    """End the process if a signal has interrupted a loop that was reported. Called with every further signal."""
    while frame is not None and _stuck:
        if frame.f_code in _stuck:
            _say("ended without cleanup: it was asked twice")
            os._exit(1)
        frame = frame.f_back


def _look() -> None:
    time.sleep(LOOK_AFTER)
    frame = sys._current_frames().get(threading.main_thread().ident or 0)
    while frame is not None:
        code = frame.f_code
        for line in lines_in(code, frame.f_lineno) if is_users(code.co_filename) else ():
            _stuck.add(code)
            _say(
                f"still running {LOOK_AFTER:.0f} s after Ctrl-C: {short_place(code.co_filename, line)} catches "
                "KeyboardInterrupt in an endless loop; write except Exception. Ctrl-C again ends it without cleanup"
            )
            return
        frame = frame.f_back


def _say(text: str) -> None:
    with suppress(OSError):  # the terminal has gone
        os.write(2, f"{text}\n".encode())


def lines_in(code: CodeType, now: int) -> Iterator[int]:
    """Yield the lines of a function that catch KeyboardInterrupt in the endless loop that it is in.

    Args:
        now: The line that it executes.
    """
    try:
        syntax = syntax_of(code.co_filename)
    except (OSError, SyntaxError, ValueError):  # no source to be read
        return
    tops: list[ast.AST] = [
        f for f in syntax.functions if (f.name, first_line(f)) == (code.co_name, code.co_firstlineno)
    ]
    for top in [syntax.module] if code.co_name == "<module>" else tops:
        for loop, _ in walk(top, into_functions=False):
            if isinstance(loop, ast.While) and loop.lineno <= now <= (loop.end_lineno or 0) and _is_endless(loop):
                handlers = (node for node in nodes_in(loop) if isinstance(node, ast.ExceptHandler))
                yield from (handler.lineno for handler in handlers if _catches_all(handler))


def _is_endless(loop: ast.While) -> bool:
    leaves = any(isinstance(node, (ast.Break, ast.Return)) for node in nodes_in(loop))
    return isinstance(loop.test, ast.Constant) and bool(loop.test.value) and not leaves


def _catches_all(handler: ast.ExceptHandler) -> bool:
    """Whether an `except` catches all that is raised, and goes on."""
    catches = handler.type is None or last_name(handler.type) == "BaseException"
    ends = (ast.Raise, ast.Call)
    calls = (node for node in nodes_in(handler) if isinstance(node, ends))
    return catches and not any(isinstance(c, ast.Raise) or last_name(c.func) in ("exit", "_exit") for c in calls)
