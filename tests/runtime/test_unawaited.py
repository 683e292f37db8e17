"""A forgotten `await` is told once, with its line."""

from __future__ import annotations

import inspect
import sys
import warnings
from collections.abc import Iterator

import pytest

from graphflow.runtime import unawaited


async def go() -> None: ...


def forgets() -> None:
    go()  # type: ignore[unused-coroutine]


def keeps() -> None:
    kept = go()
    del kept


@pytest.fixture(autouse=True)
def watched() -> Iterator[None]:
    former = warnings._warn_unawaited_coroutine  # type: ignore[attr-defined]
    unawaited._told.clear()
    unawaited.watch()
    yield
    warnings._warn_unawaited_coroutine = former  # type: ignore[attr-defined]
    sys.set_coroutine_origin_tracking_depth(0)


def test_the_line_that_lacks_it(caplog: pytest.LogCaptureFixture) -> None:
    """Where nobody keeps the coroutine; however often it happens."""
    for _ in range(3):
        forgets()
    line = inspect.getsourcelines(forgets)[1] + 1
    [message] = caplog.messages
    assert message.startswith(f"{__file__}:{line}: `go()")
    assert message.endswith("does nothing, since go is a coroutine; write await before the call")


def test_a_coroutine_that_was_kept(caplog: pytest.LogCaptureFixture) -> None:
    """Its line is known from the second time on."""
    keeps()
    assert caplog.messages == [
        "a call of go did nothing, since it was not awaited; should it happen again, its line will be told"
    ]
    keeps()
    assert f"{__file__}:{inspect.getsourcelines(keeps)[1] + 1}: `kept = go()` does nothing" in caplog.messages[1]
