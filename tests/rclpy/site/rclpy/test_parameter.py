"""Parameters as values and messages."""

from __future__ import annotations

from array import array
from pathlib import Path
from typing import Any

import pytest
from rcl_interfaces.msg import ParameterValue

from rclpy.parameter import (
    Parameter,
    get_parameter_value,
    parameter_dict_from_yaml_file,
    parameter_value_to_python,
)

VALUES: list[tuple[Any, str]] = [
    (None, "NOT_SET"),
    (True, "BOOL"),
    (3, "INTEGER"),
    (2.5, "DOUBLE"),
    ("a", "STRING"),
    ([b"a", b"b"], "BYTE_ARRAY"),
    ([True, False], "BOOL_ARRAY"),
    ([1, 2], "INTEGER_ARRAY"),
    ([1.5], "DOUBLE_ARRAY"),
    (["a"], "STRING_ARRAY"),
]


@pytest.mark.parametrize(("value", "name"), VALUES)
def test_a_value_has_a_type_and_comes_back_from_a_message(value: Any, name: str) -> None:
    """Each of its own."""
    parameter: Parameter[Any] = Parameter("p", value=value)
    assert parameter.type_ is Parameter.Type[name]
    back = Parameter.from_parameter_msg(parameter.to_parameter_msg())
    assert (back.name, back.type_, back.value) == ("p", parameter.type_, value)
    assert name in repr(parameter)


@pytest.mark.parametrize(
    ("type_", "value"),
    [("INTEGER", 1.0), ("INTEGER", True), ("DOUBLE", 1), ("BOOL", 0), ("INTEGER_ARRAY", [True]), ("STRING_ARRAY", "a")],
)
def test_a_value_of_another_type_is_refused(type_: str, value: Any) -> None:
    """An integer is no double, and a flag no integer."""
    with pytest.raises(ValueError, match="do not agree"):
        Parameter("p", Parameter.Type[type_], value)


def test_what_no_parameter_can_hold_is_refused() -> None:
    """And so is what is no type."""
    for value in ({"a": 1}, [1, "a"], object()):
        with pytest.raises(TypeError):
            Parameter("p", value=value)
    with pytest.raises(TypeError, match="must be an instance"):
        Parameter("p", 3, 3)  # type: ignore[arg-type]
    with pytest.raises(RuntimeError):
        parameter_value_to_python(ParameterValue(type=99))


def test_arrays_are_lists_of_numbers() -> None:
    """By their code."""
    assert Parameter("p", value=array("q", [1])).type_ is Parameter.Type.INTEGER_ARRAY
    assert Parameter("p", value=array("d", [1.0])).type_ is Parameter.Type.DOUBLE_ARRAY


@pytest.mark.parametrize(("text", "value"), [("1", 1), ("1.5", 1.5), ("a", "a"), ("[1, 2.5]", [1.0, 2.5]), ("", "")])
def test_a_text_is_what_it_reads_as(text: str, value: Any) -> None:
    """A list of numbers of one type."""
    assert parameter_value_to_python(get_parameter_value(text)) == value


def test_a_file_has_parameters_for_nodes(tmp_path: Path) -> None:
    """By name, and for all if that is wanted."""
    file = tmp_path / "p.yaml"
    file.write_text("/**: {ros__parameters: {a: 1}}\n/node: {ros__parameters: {b: {c: x}}}\n")
    assert list(parameter_dict_from_yaml_file(str(file))) == ["b.c"]
    found = parameter_dict_from_yaml_file(str(file), use_wildcard=True, target_nodes=["node"], namespace="ns")
    assert {name: parameter_value_to_python(m.value) for name, m in found.items()} == {"ns.a": 1, "ns.b.c": "x"}
    with pytest.raises(RuntimeError, match="does not contain parameters for /other"):
        parameter_dict_from_yaml_file(str(file), target_nodes=["/other"])
    with pytest.raises(FileNotFoundError):
        parameter_dict_from_yaml_file(str(tmp_path / "none.yaml"))
    file.write_text("[]")
    with pytest.raises(RuntimeError):
        parameter_dict_from_yaml_file(str(file))
