"""The text of the error of a message that was given other arguments than its fields."""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import Any

import pytest

from graphflow.runtime.mistakes.errors.attribute_errors import explain

HEAD = """\
from functools import partial
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import Empty, String
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.times import Duration, Time
twice = [String, String]
text = partial(String, 1)
class Mine:
    message = String
"""


def report(folder: Path, line: str) -> str:
    """Run a line of a file; returns the text of its error, as it is reported."""
    file = folder / "mistake.py"
    file.write_text(f"{HEAD}{line}\n", encoding="utf-8")
    with pytest.raises(TypeError) as caught:
        runpy.run_path(str(file))
    explain(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("String(dat='x')", "String has no field 'dat'; did you mean 'data'?"),
        ("print('é', String(\n    dat='é',\n))", "String has no field 'dat'; did you mean 'data'?"),
        ("String('x')", "String takes its fields by keyword: String(data=...)"),
        (
            "Duration(seconds=1.0)",
            "Duration.__init__() got an unexpected keyword argument 'seconds'; write Duration.of(seconds)",
        ),
        (
            "Time(seconds=1.0)",
            "Time.__init__() got an unexpected keyword argument 'seconds'; "
            "write self.clock.now(), or Time(round(seconds * 1e9))",
        ),
        ("Empty(1)", "Empty takes its fields by keyword: Empty()"),
        ("geometry_msgs.Point(1.0, y=2.0)", "Point takes its fields by keyword: Point(x=...)"),
        ("Fibonacci.Goal(ordr=3)", "Fibonacci.Goal has no field 'ordr'; did you mean 'order'?"),
        ("Fibonacci.Goal(3)", "Fibonacci.Goal takes its fields by keyword: Goal(order=...)"),
        # A class that only code of the user's could tell:
        ("twice[0](dat='x')", "Unexpected keyword argument 'dat'"),
        ("Mine.message(dat='x')", "Unexpected keyword argument 'dat'"),
        ("Mine().message('x')", "Extra positional arguments provided"),
        ("text()", "Extra positional arguments provided"),
        # Other errors:
        ("len(1)", "object of type 'int' has no len()"),
        ("raise TypeError(\"Unexpected keyword argument 'dat'\")", "Unexpected keyword argument 'dat'"),
    ],
)
def test_what_is_reported(tmp_path: Path, line: str, text: str) -> None:
    """The field that may be meant, or how fields are given."""
    assert report(tmp_path, line) == text


def test_without_the_source(tmp_path: Path) -> None:
    """Python's own text stays where the line cannot be read."""
    spaces: list[dict[str, Any]] = [{}, {}]
    for space, name in zip(spaces, ("<string>", str(tmp_path / "gone.py")), strict=True):
        exec(compile(f"{HEAD}def make(): String(dat=1)", name, "exec"), space)
        with pytest.raises(TypeError) as caught:
            space["make"]()
        explain(caught.value)
        assert str(caught.value) == "Unexpected keyword argument 'dat'"
    explain(TypeError("Extra positional arguments provided"))  # never raised
