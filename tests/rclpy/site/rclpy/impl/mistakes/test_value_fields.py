"""Fields of a parameter's value that are not of its type."""

from __future__ import annotations

import pytest

from rclpy.impl.mistakes import value_fields
from rclpy.parameter import Parameter

SPEED: Parameter[int] = Parameter("speed", value=1)
NAMES: Parameter[list[str]] = Parameter("names", value=["a"])
NONE: Parameter[None] = Parameter("none")


def told(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.getMessage() for record in caplog.records]


def test_a_field_of_another_type(caplog: pytest.LogCaptureFixture) -> None:
    """It is told once for each line, with the field that has the value, or with the way to give it one."""
    line = test_a_field_of_another_type.__code__.co_firstlineno
    for _ in range(2):
        assert SPEED.get_parameter_value().double_value == 0.0
    kept = NAMES.get_parameter_value()
    assert kept.string_value == ""
    assert NONE.get_parameter_value().integer_array_value.tolist() == []
    assert told(caplog) == [
        f"test_value_fields.py:{line + 4}: speed is an integer: .integer_value has the value, .double_value is 0.0",
        f"test_value_fields.py:{line + 5}: names is a string array: .string_array_value has the value, "
        ".string_value is ''",
        f"test_value_fields.py:{line + 7}: none has no value, so that .integer_array_value is []: give it one, as in "
        "declare_parameter('none', [0])",
    ]


def test_fields_that_fit(caplog: pytest.LogCaptureFixture) -> None:
    """Nothing is told of them, of code that looks at the type, or of a variable that has another value by then."""
    assert SPEED.get_parameter_value().integer_value == 1
    value = SPEED.get_parameter_value()
    assert (value.double_value if value.type == 3 else value.integer_value) == 1
    value = NAMES.get_parameter_value()
    value = SPEED.get_parameter_value()
    assert value.integer_value == 1
    assert [p.get_parameter_value() for p in (SPEED, NAMES)] != []
    assert told(caplog) == []


def test_code_that_is_compiled_again_and_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A limited number of calls is remembered."""
    monkeypatch.setattr(value_fields, "_seen", seen := set[object]())
    monkeypatch.setattr(value_fields, "SEEN_BOUND", 3)
    for number in range(5):
        exec(f"value_{number} = speed.get_parameter_value()", {"speed": SPEED})
    assert len(seen) == 3
