"""Corrections of parameters in graph files."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import Place
from graphflow.graph.checks.parameter_slips import (
    misplaced_key,
    remark_on_texts,
    set_in_a_method,
    value_correction,
)
from graphflow.graph.plan import Setting
from graphflow.interface import Parameter
from graphflow.markup import source
from graphflow.markup.tree import tree

CODE = Place("code.py", 1)
RATE = Parameter("rate", "float", 1.0, CODE, gt=0.0)
COUNT = Parameter("count", "int", 1, CODE)
GAINS = Parameter("gains", "list[float]", [0.0], CODE)


def correction(folder: Path, declared: Parameter, written: str, value: object, name: str = "g.yaml") -> str:
    """Return the correction of a value, as it is written in a file and with its substitutions made."""
    file = folder / name
    file.write_text(f"params: {{{declared.name}: {written}, more: 1}}\n")
    column = len(f"params: {{{declared.name}: ") + 1
    return value_correction(declared, Setting(value, Place(str(file), 1, column)))


@pytest.mark.parametrize(
    ("written", "value", "way"),
    [
        ("$(var fast) * 2", "2.0 * 2", "write rate: $(eval fast * 2)"),
        ("2 * $(var a-b)", "2 * 3", "write rate: $(eval 2 * 3)"),
        ("1/2", "1/2", "write rate: $(eval 1/2)"),
        ("'pi/2'", "pi/2", "write rate: $(eval pi/2)"),
        ("(1 + 2) / 4", "(1 + 2) / 4", "write rate: $(eval (1 + 2) / 4)"),
        ("'2.0'", "2.0", "leave out the quotes: rate: 2.0"),
        ("1 - 2", "1 - 2", ""),
        ("5 Hz", "5 Hz", ""),
        ("a/b", "a/b", ""),
        ("1/0", "1/0", ""),
        ("/dev/ttyUSB0", "/dev/ttyUSB0", ""),
        ("$(var fast)", "2.0", ""),
    ],
)
def test_expressions(tmp_path: Path, written: str, value: str, way: str) -> None:
    """An expression becomes a substitution if the parameter could have its value; other texts have no such hint."""
    assert correction(tmp_path, RATE, written, value) == way


def test_expressions_of_other_files(tmp_path: Path) -> None:
    """No substitutions of that form are made in launch files and parameter files: the result is given."""
    assert correction(tmp_path, RATE, "1/2", "1/2", "a.launch.yaml") == "write rate: 0.5"
    assert correction(tmp_path, RATE, "1/2", "1/2", "a.xml") == "write rate: 0.5"
    file = tmp_path / "p.yaml"
    file.write_text("/t:\n  ros__parameters:\n    count: 2*3\n")
    assert value_correction(COUNT, Setting("2*3", Place(str(file), 3, 12))) == "write count: 6"


def test_units(tmp_path: Path) -> None:
    """The unit of the parameter is left out; any other is not converted."""
    speed = Parameter("speed", "float", 1.0, CODE, unit="m/s")
    assert correction(tmp_path, speed, "1.5 m/s", "1.5 m/s") == "write speed: 1.5, without the unit"
    assert correction(tmp_path, speed, "1.5 km/h", "1.5 km/h") == ""
    assert correction(tmp_path, speed, "fast m/s", "fast m/s") == ""


def test_lists(tmp_path: Path) -> None:
    """A list without brackets gets them."""
    assert correction(tmp_path, GAINS, "'1.0, 2.0'", "1.0, 2.0") == "a list is written with brackets: [1.0, 2.0]"


def test_keys_of_nodes() -> None:
    """A key of a node that stands below `params:` is told from a misspelt parameter."""
    assert misplaced_key("remap.chatter", ["rate"]) == (
        "remap",
        "; remap is a key of the node: indent it as params: is",
    )
    assert misplaced_key("log_level", ["rate"])[0] == "log_level"
    assert misplaced_key("args", ["arg"]) == ("", "")
    assert misplaced_key("rte", ["rate"]) == ("", "")


def test_a_parameter_that_a_method_sets(tmp_path: Path) -> None:
    """It is declared in the body of its class."""
    file = tmp_path / "walker.py"
    file.write_text(
        "class Walker(Node):\n    def __init__(self):\n        self.speed = Param(1.0)\n        self.rate = 1.0\n"
    )
    place = Place(str(file), 1)
    assert set_in_a_method("speed", place) == (
        f"; write speed = Param(...) in the body of the class, and not in {file}:3"
    )
    assert set_in_a_method("rate", place) == ""
    assert set_in_a_method("speed", Place("nowhere.py", 1)) == ""


def test_texts_for_arguments() -> None:
    """A value is meant as an argument only where parameter and argument have that name."""
    written = source.read("{rate: rate, map: $(var map), frame: map, mode: mode}", "g.launch.py")
    found: list[str] = []
    for params in (tree(written), None):
        remark_on_texts(params, {"rate", "map"}, lambda place, text: found.append(f"{place}: {text}"))
    way = "write LaunchConfiguration('rate')"
    assert found == [f"g.launch.py:1:8: 'rate' is a text here; for the argument of that name {way}"]
