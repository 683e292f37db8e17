"""Values of parameters from outside."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rclpy.exceptions import InvalidParameterTypeException, ParameterNotDeclaredException
from rclpy.impl.overrides import as_parameters, remark
from rclpy.node import Node
from rclpy.parameter import Parameter

Kind = Parameter.Type


@pytest.mark.parametrize(
    ("value", "kind", "written"),
    [
        (5, Kind.DOUBLE, "gain: 5.0"),
        ("5,0", Kind.DOUBLE, "gain: 5.0"),
        (5.0, Kind.INTEGER, "gain: 5"),
        (7, Kind.STRING, "gain: '7'"),
        (1, Kind.BOOL, "gain: true"),
        ("1.0, 2.0", Kind.DOUBLE_ARRAY, "gain: [1.0, 2.0]"),
        ([1, 2], Kind.DOUBLE_ARRAY, "gain: [1.0, 2.0]"),
        ([1, 2], Kind.STRING_ARRAY, "gain: ['1', '2']"),
        ([1, "a"], Kind.INTEGER_ARRAY, ""),
        ([1], Kind.STRING, ""),
        (b"", Kind.BYTE_ARRAY, ""),
    ],
)
def test_how_a_value_is_written(value: Any, kind: Parameter.Type, written: str) -> None:
    """For the type that the parameter has; only where it was set for one that it cannot have."""
    text = "gain is set in lamp.yaml:3" + (f": write {written}" if written else "")
    assert remark("gain", value, "/home/lamp.yaml:3", kind) == text


def test_the_command_line() -> None:
    """A value with spaces or quotes stands in quotes."""
    assert remark("gain", 7, "command line", Kind.DOUBLE) == "gain is set on the command line: write -p gain:=7.0"
    told = remark("on", True, "command line", Kind.STRING)
    assert told.endswith("""write -p "on:='true'", or declare it as declare_parameter('on', True)""")
    assert remark("name", 7, "command line", Kind.STRING).endswith("""write -p "name:='7'\"""")


def test_a_value_that_is_no_number() -> None:
    """It is told what is needed, wherever it is set."""
    of = {Kind.DOUBLE: "a number, such as 2.0", Kind.INTEGER: "an integer, such as 2", Kind.BOOL: "true or false"}
    for kind, needed in of.items():
        assert remark("gain", "hot", "command line", kind) == f"gain is set on the command line: it needs {needed}"
        assert remark("gain", "hot", "/home/lamp.yaml:3", kind) == f"gain is set in lamp.yaml:3: it needs {needed}"
    told = remark("gain", 5.5, "command line", Kind.INTEGER)
    assert told.endswith("it needs an integer, such as 2, or, for a double, declare_parameter('gain', 1.0)")


@pytest.mark.parametrize(
    ("name", "lines", "way"),
    [
        ("t.launch.xml", '<param name="gain" value="7"/>', ': write value="7.0"'),
        (
            "t.launch.xml",
            '<param name="gain" value="$(var gain)"/>',
            ': write gain:=7.0, or add there type="float"',
        ),
        ("t.launch.yaml", "- {name: gain, value: $(var g)}", ": write g:=7.0, or add there type: float"),
        ("t.launch.yaml", "- {name: gain, value: 7}", ": write value: 7.0"),
        ("t.yaml", "params: {gain: 7}", ": write gain: 7.0"),
        ("t.yaml", "params: {gain: $(var gain)}", ": write gain:=7.0"),
        ("t.py", 'Node(parameters=[{"gain": 7}])', ': write "gain": 7.0'),
        (
            "t.py",
            "Node(\n    parameters=[{'gain': LaunchConfiguration('gain')}],\n)",
            ": write ParameterValue(LaunchConfiguration(...), value_type=float)",
        ),
        ("t.py", "Node(\n    parameters=[{'gain': gain_of(3)}],\n)", ""),
    ],
)
def test_files(tmp_path: Path, name: str, lines: str, way: str) -> None:
    """The correction is in the form of the file; a value that a substitution makes has none there."""
    (tmp_path / name).write_text(f"{lines}\n")
    assert remark("gain", 7, f"{tmp_path / name}:1", Kind.DOUBLE) == f"gain is set in {name}:1{way}"


@pytest.mark.parametrize(
    ("name", "declared", "way"),
    [
        ("t.launch.py", "DeclareLaunchArgument('gain', default_value='2')", "LaunchConfiguration('gain')"),
        ("t.launch.py", 'DeclareLaunchArgument(name="gain")', "LaunchConfiguration('gain')"),
        ("t.launch.xml", '<arg name="gain"/>', "$(var gain)"),
        ("t.launch.yaml", "- arg: {name: gain}", "$(var gain)"),
        ("t.launch.yaml", "- arg:\n    name: gain\n", "$(var gain)"),
        ("t.launch.yaml", "- arg: {name: gains}", ""),
        ("t.yaml", "- arg: {name: gain}", ""),
    ],
)
def test_the_name_of_an_argument(tmp_path: Path, name: str, declared: str, way: str) -> None:
    """In its place stands the argument, as the language of the file writes it."""
    (tmp_path / name).write_text(f"{declared}\n")
    found = remark("gain", "gain", f"{tmp_path / name}:1", Kind.DOUBLE)
    told = (
        f" to the text 'gain': for the argument of that name write {way}" if way else ": it needs a number, such as 2.0"
    )
    assert found == f"gain is set in {name}:1{told}"


def test_a_value_that_no_parameter_has() -> None:
    """It is told where it is written, and as what it could be."""
    with pytest.raises(TypeError) as caught:
        as_parameters({"goal": ([1, 2.5], "lamp.yaml:3")})
    assert caught.value.__notes__ == ["note: goal is set in lamp.yaml:3: write goal: [1.0, 2.5]"]


def test_a_node_whose_parameter_is_of_another_type(network: Any) -> None:
    """The error has the place and the form; one that is not declared has the nearest name, or the call."""
    import rclpy

    rclpy.init()
    node = Node("lamp", cli_args=["--ros-args", "-p", "gain:=7"])
    with pytest.raises(InvalidParameterTypeException) as wrong:
        node.declare_parameter("gain", 1.0)
    assert wrong.value.__notes__ == ["note: gain is set on the command line: write -p gain:=7.0"]
    node.declare_parameter("speed", 1.0)
    for name, way in (("sped", "did you mean 'speed'?"), ("x", "declare it first: declare_parameter('x', 1.0)")):
        with pytest.raises(ParameterNotDeclaredException) as caught:
            node.get_parameter(name)
        assert caught.value.__notes__ == [f"note: {way}"]
        with pytest.raises(ParameterNotDeclaredException) as caught:
            node.set_parameters([Parameter(name, value=2.0)])
        assert caught.value.__notes__ == [f"note: {way}"]
