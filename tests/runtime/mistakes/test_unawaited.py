"""A forgotten `await` is reported once, with its line."""

from __future__ import annotations

import _thread
import inspect
import sys
import warnings
from collections.abc import Iterator
from queue import Queue
from typing import Any

import pytest

from graphflow.runtime.mistakes import unawaited


async def go() -> None: ...


def forgets() -> None:
    go()  # type: ignore[unused-coroutine]


def keeps() -> None:
    kept = go()
    del kept


@pytest.fixture(autouse=True)
def watched() -> Iterator[None]:
    former = warnings._warn_unawaited_coroutine  # type: ignore[attr-defined]
    unawaited._reported.clear()
    unawaited.watch()
    yield
    warnings._warn_unawaited_coroutine = former  # type: ignore[attr-defined]
    sys.set_coroutine_origin_tracking_depth(0)


def test_the_line_that_lacks_it(caplog: pytest.LogCaptureFixture) -> None:
    """If the coroutine is not stored; once, however often it happens."""
    for _ in range(3):
        forgets()
    line = inspect.getsourcelines(forgets)[1] + 1
    [message] = caplog.messages
    assert message.startswith(f"{__file__}:{line}: `go()")
    assert message.endswith("does nothing, since go is a coroutine function; write await before it, in an async def")


def test_the_functions_that_lack_it(caplog: pytest.LogCaptureFixture) -> None:
    """The line is remembered, for those who ask why the function does not pause."""
    assert unawaited.forgotten_in(forgets.__code__) == ""
    forgets()
    assert unawaited.forgotten_in(forgets.__code__) == f"{__file__}:{inspect.getsourcelines(forgets)[1] + 1}"
    assert unawaited.forgotten_in(keeps.__code__) == ""


@pytest.mark.parametrize(
    ("line", "call"),
    [
        ("show(self.adder.go(add(1), (2)))", "self.adder.go(add(1), (2))"),
        ("while not self.go(1.0):", "self.go(1.0)"),
        ("total = go(", "total = go("),
        ("async with self.goals.go(x):", "async with self.goals.go(x):"),
        ("self.ergo(1)", "self.ergo(1)"),
    ],
)
def test_the_call_in_a_line(line: str, call: str) -> None:
    """Only the call lacks its await; where it is not the whole of one, the line is shown."""
    assert unawaited._call_in(line, "go") == call


def test_a_name_that_is_no_identifier() -> None:
    """A decorator may give a function any name."""
    assert unawaited._call_in("self.go(1)", "go(*") == "self.go(1)"


def test_a_coroutine_that_was_kept(caplog: pytest.LogCaptureFixture) -> None:
    """Its line is known from the second time on."""
    keeps()
    assert caplog.messages == [
        "a call of go did nothing, since it was not awaited; if it happens again, its line will be logged"
    ]
    keeps()
    assert f"{__file__}:{inspect.getsourcelines(keeps)[1] + 1}: `go()` does nothing" in caplog.messages[1]


def test_a_coroutine_that_ends_where_no_python_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """As at interpreter exit or in a foreign thread: there is no line, and no error about that."""
    told: Queue[str] = Queue()
    monkeypatch.setattr(unawaited.logger, "error", lambda text, *args: told.put(text % args))
    coroutine = go()
    _thread.start_new_thread(unawaited.report, (coroutine,))
    assert told.get(timeout=10).startswith("a call of go did nothing")
    coroutine.close()


def test_a_goal_that_is_sent_by_the_other_name(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`async with client.send_goal(...)` needs no await, but `send`."""
    text = "async with self.goals.send_goal(goal) as sent:"
    monkeypatch.setattr(unawaited, "_origin", lambda *_: ("drive.py:5", text))

    async def send_goal() -> None: ...

    coroutine: Any = send_goal()
    coroutine.__qualname__ = "GoalClient.send_goal"
    unawaited.report(coroutine)
    coroutine.close()
    assert caplog.messages[0].endswith("is a coroutine function; write send instead of send_goal")


def test_only_so_many_lines_are_remembered(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    """Beyond them, nothing is told: code that is made anew at each call would have any number."""
    monkeypatch.setattr(unawaited, "PLACES_BOUND", 0)
    forgets()
    assert caplog.messages == []
