"""Which code is the user's own, and what of an error or a stack points at it."""

from __future__ import annotations

import json
import re
import sys
import sysconfig
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import FrameType, TracebackType
from typing import Any

import pytest

import graphflow
from graphflow import Node, Qos, names
from graphflow.analysis.frames import Frame, running
from graphflow.analysis.user_code import Pause, innermost, is_users, place_in, users_part, variable_of, where
from graphflow.errors import Place

STDLIB = Path(sysconfig.get_path("stdlib"))
OURS = Path(graphflow.__file__).parent


@pytest.mark.parametrize(
    ("file", "is_own"),
    [
        (__file__, True),
        ("/home/me/arm.py", True),
        ("<string>", True),
        (str(STDLIB / "site-packages" / "numpy" / "core.py"), True),
        (str(STDLIB / "asyncio" / "tasks.py"), False),
        ("uvloop/handles/process.pyx", False),
        (str(OURS / "runtime" / "node.py"), False),
        ("<frozen importlib._bootstrap>", False),
    ],
)
def test_whose_file_it_is(file: str, is_own: bool) -> None:
    """Neither graphflow's nor Python's own; installed packages count as the user's."""
    assert is_users(file) is is_own


def frames_inside() -> list[Frame]:
    """The stack, the outermost first, of a function that the standard library calls."""
    found: list[Frame] = []

    def called(_: object) -> str:
        frame: FrameType | None = sys._getframe()
        while frame is not None:
            found.insert(0, running(frame))
            frame = frame.f_back
        return ""

    re.sub("a", called, "a")
    return found


def test_the_innermost_line_of_the_users() -> None:
    """It is the last of the frames that is in a file of the user's."""
    frames = frames_inside()
    library = [frame for frame in frames if not is_users(frame.f_code.co_filename)]
    assert library

    assert innermost(frames) is frames[-1]
    assert innermost([*frames, library[0]]) is frames[-1]
    assert innermost(library) is None
    assert innermost([]) is None


def test_the_variable_that_holds_an_object() -> None:
    """It is that of the first frame with one."""
    held = object()

    def frame(_: object) -> FrameType:
        return sys._getframe()

    here, there, nowhere = sys._getframe(), frame(held), frame(None)
    assert variable_of(held, [nowhere, here, there], "it") == "held"
    assert variable_of(held, [there, here], "it") == "_"
    assert variable_of(held, [nowhere], "it") == "it"


class Driver:
    """Polls, and does something else in between."""

    def drive(self) -> list[Frame]:
        while not (frames := self.look()):
            time.sleep(0.1)
        return frames

    def look(self) -> list[Frame]:
        return frames_inside()


def test_where_a_loop_that_polls_is() -> None:
    """At its pause, wherever it was seen."""
    driver = Driver()
    frames = driver.drive()
    loop = next(frame for frame in frames if frame.f_code is Driver.drive.__code__)
    first = Driver.drive.__code__.co_firstlineno

    seen = where(frames, driver)
    assert (seen.place.file, seen.function) == (__file__, "called")
    assert seen.called == f"test_user_code.py:{first + 1} in drive"

    assert where(frames, driver, Pause(loop, first + 2)) == (Place(__file__, first + 2), "drive", False, "")
    assert where(frames[:3], driver, Pause(loop, first + 2)) == where(frames[:3], driver)
    assert where([], driver) == (Place(""), "", False, "")


def test_where_one_may_await() -> None:
    """In the code of an `async def`."""

    async def waits() -> None: ...

    waiting: Any = waits()
    assert where([waiting.cr_frame], None).is_async
    waiting.close()


def raised_in_the_library() -> Exception:
    """An error that Python's own code raises when this file calls it."""
    try:
        json.loads("nonsense")
    except ValueError as error:
        return error
    raise AssertionError


def test_the_place_of_an_error() -> None:
    """It is the last of the user's own lines that it passed through; an error that was never raised has none."""
    line = raised_in_the_library.__code__.co_firstlineno + 3

    assert place_in(raised_in_the_library()) == f"{__file__}:{line}"
    assert place_in(ValueError()) == ""


def test_an_error_about_the_values_of_a_dataclass() -> None:
    """Is where the user has made it, and not in the `__init__` that Python wrote, which belongs to graphflow."""
    values: dict[str, Any] = {"depth": "10"}
    with pytest.raises(ValueError, match="whole number") as caught:
        Qos(**values)
    assert place_in(caught.value) == f"{__file__}:{caught.traceback[0].lineno + 1}"
    last = users_part(caught.value)
    assert last is not None
    assert (last.tb_frame.f_code.co_filename, last.tb_next) == (__file__, None)


@pytest.mark.parametrize("library", ["/opt/lib/python3/site-packages/serial/posix.py", "numpy/random/mtrand.pyx"])
def test_an_error_in_a_library(library: str) -> None:
    """Is the user's where it was called; an installed node's is where it was raised."""
    scope: dict[str, Any] = {}
    exec(compile("def fail():\n    raise OSError", library, "exec"), scope)

    with pytest.raises(OSError) as caught:
        scope["fail"]()
    assert place_in(caught.value) == f"{__file__}:{caught.traceback[0].lineno + 1}"

    alone = caught.value.with_traceback(caught.tb.tb_next)
    assert place_in(alone) == (f"{library}:2" if library.endswith(".py") else "")


def names_that_fail() -> Iterator[str]:
    raise ValueError
    yield "not reached"


def traceback_of(choices: Iterable[Any]) -> TracebackType | None:
    """Where an error passed through that begins in graphflow, with these."""
    with pytest.raises((ValueError, TypeError)) as caught:
        names.did_you_mean("word", choices)
    error = caught.value
    assert error.__traceback__ is not None
    error.__traceback__ = error.__traceback__.tb_next  # as where graphflow was not called by this test
    found = users_part(error)
    return found


def test_the_users_part_of_a_traceback() -> None:
    """The frames of graphflow with which it begins are left out; what is graphflow's alone is left whole."""
    called, alone = traceback_of(names_that_fail()), traceback_of([object(), object()])

    assert called is not None
    assert called.tb_frame.f_code is names_that_fail.__code__
    assert alone is not None
    assert alone.tb_frame.f_code is names.did_you_mean.__code__
    assert users_part(ValueError()) is None


def frames_of(trace: TracebackType | None) -> list[str]:
    return [] if trace is None else [trace.tb_frame.f_code.co_name, *frames_of(trace.tb_next)]


def test_what_graphflow_refuses() -> None:
    """Such an error ends at the user's line; one that happens in graphflow keeps the frames in which it did."""
    node: Any = Node("n")
    with pytest.raises(AttributeError) as refused:
        node.foo()
    with pytest.raises(TypeError) as failed:
        names.did_you_mean("word", [object()])  # type: ignore[list-item]
    own = "test_what_graphflow_refuses"
    assert frames_of(users_part(refused.value)) == [own]
    first, *others = frames_of(users_part(failed.value))
    assert first == own
    assert others
