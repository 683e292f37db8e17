"""Where users have written what is called."""

from __future__ import annotations

import inspect
from pathlib import Path

from graphflow.runtime import place
from graphflow.runtime.place import here


def called() -> str:
    """As a function of the room is called by users."""
    return str(here())


def test_the_line_of_the_caller() -> None:
    """Not the one in which it is asked."""
    frame = inspect.currentframe()
    assert frame is not None
    assert called() == f"{Path(__file__)}:{frame.f_lineno}"


def test_frames_of_the_room_are_left_out() -> None:
    """However many there are."""
    inner = eval(compile("lambda: here()", str(Path(place.__file__).with_name("deep.py")), "eval"), {"here": here})
    outer = eval(compile("lambda: inner()", str(Path(place.__file__).with_name("deep.py")), "eval"), {"inner": inner})
    frame = inspect.currentframe()
    assert frame is not None
    assert outer().line == frame.f_lineno
