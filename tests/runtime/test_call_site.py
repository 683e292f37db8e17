"""Places of calls in user code."""

from __future__ import annotations

import inspect
from pathlib import Path

from graphflow.runtime import call_site
from graphflow.runtime.call_site import here


def called() -> str:
    """As a function of the room is called by users."""
    return str(here())


def test_the_line_of_the_caller() -> None:
    """Not the line of the inner call."""
    frame = inspect.currentframe()
    assert frame is not None
    assert called() == f"{Path(__file__)}:{frame.f_lineno}"


def test_frames_of_the_room_are_left_out() -> None:
    """However many there are."""
    file = str(Path(call_site.__file__).with_name("deep.py"))
    inner = eval(compile("lambda: here()", file, "eval"), {"here": here})
    outer = eval(compile("lambda: inner()", file, "eval"), {"inner": inner})
    frame = inspect.currentframe()
    assert frame is not None
    assert outer().line == frame.f_lineno
