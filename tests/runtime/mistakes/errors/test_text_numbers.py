"""Numbers that are texts."""

from __future__ import annotations

import linecache
import math
from typing import Any

import pytest

from graphflow import Node, Param
from graphflow.runtime.mistakes.errors.python_errors import remark_on


class Robot(Node):
    gain = Param("5.0")
    count = Param("3")
    word = Param("fast")
    rate = Param(2.0)
    limit: Any = "1e3"


GAIN = "self.gain is the string '5.0': write gain = Param(5.0)"


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("self.rate * self.gain * 2.0", GAIN),
        ("2.0 * self.gain", GAIN),
        ("self.gain / 2", GAIN),
        ("-self.gain", GAIN),
        ("1.0 < self.gain", GAIN),
        ("math.sin(self.gain)", GAIN),
        ("self.count - 1", "self.count is the string '3': write count = Param(3)"),
        ("self.limit - 1", "self.limit is the string '1e3': write 1000.0, without quotes"),
        ("self.word - 1", ""),
        ("self.rate - self.word", ""),
        ("self.name * 2.0", ""),
        ("self.gone.x", ""),
    ],
)
def test_a_line_that_calculates(line: str, told: str) -> None:
    """The hint is for an attribute that is a string with a number."""
    space: dict[str, Any] = {"math": math}
    source = f"def work(self):\n    {line}\n"
    file = "/tmp/text_numbers_robot.py"
    linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
    exec(compile(source, file, "exec"), space)
    with pytest.raises((TypeError, AttributeError)) as caught:
        space["work"](Robot())
    assert remark_on(caught.value) == told
