"""Results of calls that were not awaited."""

from __future__ import annotations

import asyncio
import traceback
from pathlib import Path
from typing import Any

import pytest

from graphflow.runtime.mistakes.errors.python_errors import remark_on

HEAD = "async def call(n):\n    return n\n\nasync def use():\n"


def told(file: Path, body: str) -> str:
    """The remark on what a function's body raises; the body begins on line 5."""
    file.write_text(source := HEAD + "".join(f"    {line}\n" for line in body.splitlines()))
    space: dict[str, Any] = {"__name__": "asks"}
    exec(compile(source, str(file), "exec"), space)
    try:
        asyncio.run(space["use"]())
    except Exception as error:
        found = remark_on(error)
        traceback.clear_frames(error.__traceback__)  # the coroutine ends here, and not in another test
        return found
    raise AssertionError("nothing was raised")


@pytest.mark.filterwarnings("ignore:coroutine")
@pytest.mark.parametrize(
    ("body", "way"),
    [
        ("answer = call(1)\nanswer.sum", "write answer = await call(1), in asks.py:5"),
        ("answer = await call(1)\nanswer = call(2)\nanswer + 1", "write answer = await call(2), in asks.py:6"),
        ("call(1).sum", "that is a coroutine: write await before the call"),
        ("answer = [call(1)][0]\nanswer.sum", "that is a coroutine: write await before the call"),
    ],
)
def test_the_line_that_lacks_its_await(tmp_path: Path, body: str, way: str) -> None:
    """It is shown as it should be, if a variable of the function has the coroutine."""
    assert told(tmp_path / "asks.py", body) == way
