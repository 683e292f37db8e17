"""Parameters by rclpy's rules."""

from __future__ import annotations

from typing import Any

import pytest
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, SetParametersResult

from rclpy.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from rclpy.impl.parameters import NodeParameters
from rclpy.node import Node
from rclpy.parameter import Parameter

P = Parameter
Kind = Parameter.Type


def some(overrides: dict[str, Any] | None = None, *, undeclared: bool = False) -> NodeParameters:
    given: dict[str, Parameter[Any]] = {name: P(name, value=value) for name, value in (overrides or {}).items()}
    return NodeParameters(given, lambda now, former: None, allows_undeclared=undeclared)


def test_what_is_given_from_outside_comes_before_a_default() -> None:
    """Unless the declaration does not want it; its type must be right."""
    parameters = some({"a": 5, "b": 5, "c": "text"})
    declared = parameters.declare("", [("a", 1)])[0]
    assert (declared.name, declared.value) == ("a", 5)
    assert parameters.declare("", [("b", 1)], ignore_override=True)[0].value == 1
    with pytest.raises(InvalidParameterTypeException, match="expecting type 'INTEGER'"):
        parameters.declare("", [("c", 1)])
    assert "c" not in parameters.values
    with pytest.raises(ParameterAlreadyDeclaredException):
        parameters.declare("", [("a", 1)])


@pytest.mark.parametrize(
    ("given", "error", "text"),
    [
        ((), TypeError, "expecting length between 1 and 3"),
        ((1, 2), TypeError, "is not a str"),
        (("a", 1, 2), TypeError, "is not a ParameterDescriptor"),
        (("a", Kind.NOT_SET), ValueError, "type NOT_SET"),
        (("a", Kind.DOUBLE, ParameterDescriptor(dynamic_typing=True)), ValueError, "must not be given"),
        (("a", None, ParameterDescriptor()), ValueError, "without a value"),
    ],
)
def test_a_wrong_declaration_is_an_error(given: Any, error: type[Exception], text: str) -> None:
    """Of the caller's."""
    with pytest.raises(error, match=text):
        some().declare("", [given])


def test_a_declaration_by_name_alone_is_deprecated() -> None:
    """It may hold anything."""
    parameters = some()
    with pytest.warns(UserWarning, match="deprecated"):
        parameters.declare("ns", [("a",)])
    assert parameters.get("ns.a").value is None
    assert parameters.set_each([P("ns.a", value="x")])[0].successful
    assert parameters.describe("ns.a").type == 4


def test_one_with_a_type_only_has_no_value_yet() -> None:
    """And says so; of its type it must be."""
    parameters = some()
    parameters.declare("", [("a", Kind.INTEGER)])
    with pytest.raises(ParameterUninitializedException):
        parameters.get("a")
    refused = parameters.set_each([P("a", value=1.0)])[0]
    assert refused.reason == "Wrong parameter type, expected 'Type.INTEGER' got 'Type.DOUBLE'"
    assert parameters.set_each([P("a", value=1)])[0].successful
    assert parameters.get("a").value == 1


@pytest.mark.parametrize(
    ("value", "bounds", "good", "wrong"),
    [
        (2, {"integer_range": [IntegerRange(from_value=0, to_value=9, step=2)]}, [0, 8, 9], [-1, 10, 3]),
        (
            0.5,
            {"floating_point_range": [FloatingPointRange(from_value=0.0, to_value=1.0, step=0.25)]},
            [0.0, 0.75, 1.0, 1.0 + 1e-9],
            [-0.1, 1.1, 0.3],
        ),
    ],
)
def test_a_value_must_be_in_its_range_and_on_a_step(value: Any, bounds: Any, good: Any, wrong: Any) -> None:
    """From the first to the last."""
    parameters = some()
    parameters.declare("", [("a", value, ParameterDescriptor(**bounds))])
    for each in good:
        assert parameters.set_each([P("a", value=each)])[0].successful, each
    for each in wrong:
        result = parameters.set_each([P("a", value=each)])[0]
        assert not result.successful, each
        assert "a" in result.reason
    with pytest.raises(InvalidParameterValueException):
        parameters.declare("", [("b", wrong[0], ParameterDescriptor(**bounds))])


def test_callbacks_before_at_and_after_a_change() -> None:
    """The first says what is set, the second whether, the third hears of it."""
    parameters, heard = some(), list[Any]()
    parameters.declare("", [("a", 1), ("b", 1)])
    parameters.before.append(lambda given: [*given, P("b", value=7)])
    parameters.checks.append(lambda given: SetParametersResult(successful=given[0].value < 10, reason="too much"))
    parameters.after.append(lambda given: heard.append([p.name for p in given]))
    assert parameters.set_all([P("a", value=5)]).successful
    assert (parameters.get("b").value, heard) == (7, [["a", "b"]])
    assert parameters.set_all([P("a", value=50)]).reason == "too much"
    assert parameters.get("a").value == 5
    parameters.before[:] = [lambda given: []]
    assert "cannot be empty" in parameters.set_all([P("a", value=5)]).reason


def test_undeclared_ones_are_refused_or_not() -> None:
    """As the node wants it; then they may be of any type, and deleted."""
    with pytest.raises(ParameterNotDeclaredException):
        some().set_each([P("a", value=1)])
    with pytest.raises(ParameterNotDeclaredException):
        some().get("a")
    with pytest.raises(TypeError):
        some().set_each([42])  # type: ignore[list-item]
    free = some(undeclared=True)
    assert free.get("a").type_ is Kind.NOT_SET
    for value in (1, "x", None):
        assert free.set_all([P("a", value=value)]).successful
    assert "a" not in free.values


def test_what_is_read_only_is_not_changed() -> None:
    """Nor undeclared, nor described anew."""
    parameters = some()
    parameters.declare("", [("a", 1, ParameterDescriptor(read_only=True)), ("b", 1)])
    assert parameters.set_each([P("a", value=2)])[0].reason == "Trying to set a read-only parameter: a."
    with pytest.raises(ParameterImmutableException):
        parameters.undeclare("a")
    with pytest.raises(ParameterImmutableException):
        parameters.set_descriptor("a", ParameterDescriptor(), None)
    parameters.undeclare("b")
    with pytest.raises(ParameterNotDeclaredException):
        parameters.undeclare("b")
    assert not parameters.set_each([P("a", Kind.NOT_SET)])[0].successful


def test_a_parameter_may_be_described_anew() -> None:
    """With another value, if the old one does not fit."""
    parameters = some()
    parameters.declare("", [("a", 1)])
    bounds = ParameterDescriptor(integer_range=[IntegerRange(from_value=5, to_value=9)])
    with pytest.raises(InvalidParameterValueException, match="out of range"):
        parameters.set_descriptor("a", bounds, None)
    value = P("a", value=6).get_parameter_value()
    assert parameters.set_descriptor("a", bounds, value) == value
    assert parameters.describe("a").type == 2


def test_names_are_listed_by_prefix_and_depth() -> None:
    """0 is any depth."""
    parameters = some()
    parameters.declare("", [(name, 1) for name in ("a", "b.c", "b.d.e")])
    assert parameters.listed([], 0).names == ["a", "b.c", "b.d.e"]
    assert parameters.listed([], 1).names == ["a"]
    assert parameters.listed(["b"], 1).names == ["b.c"]
    assert parameters.listed(["b"], 0).prefixes == ["b", "b.d"]
    assert parameters.with_prefix("b").keys() == {"c", "d.e"}
    for wrong in list[Any]([("b", 0), ([1], 0), ([], 1.5)]):
        with pytest.raises(TypeError):
            parameters.listed(*wrong)
    with pytest.raises(ValueError, match="negative"):
        parameters.listed([], -1)


def test_words_for_truth_values() -> None:
    """Are such where one is declared, as in ROS 2's parameter files; elsewhere they are texts."""
    parameters = some({"a": "yes", "b": "Off", "c": "on", "d": "maybe"})
    declared = parameters.declare("", [("a", False), ("b", True), ("c", "text")])
    assert [parameter.value for parameter in declared] == [True, False, "on"]
    with pytest.raises(InvalidParameterTypeException, match="expecting type 'BOOL'"):
        parameters.declare("", [("d", True)])


def test_a_string_in_place_of_a_tuple(node: Node) -> None:
    """One of two characters is taken, with a warning that shows the line."""
    with pytest.warns(
        UserWarning, match=r"'kp' is a string.* declares 'k' with the value 'p': write \('kp', 1.0\)"
    ) as got:
        node.declare_parameters("", [("kp")])
    assert [warning.filename for warning in got] == [__file__]
    assert node.get_parameter("k").value == "p"
