"""Message classes: constructors, fields and defaults."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from graphflow.errors import InterfaceError
from graphflow.msgs import base, registry
from graphflow.wire.schema import Message
from tests.msgs.conftest import make

if TYPE_CHECKING:
    from .conftest import Save


def test_a_class_is_where_it_is_imported_from() -> None:
    """A class knows its module, its name, its schema, and what it holds."""
    cls = registry.interface_class("geometry_msgs/msg/Point")
    assert (cls.__module__, cls.__name__) == ("graphflow.msgs.geometry_msgs.msg", "Point")
    assert cls.__doc__ == "geometry_msgs/msg/Point: float64 x, float64 y, float64 z."
    assert issubclass(cls, base.Message)
    assert registry.message_schema("geometry_msgs/msg/Point") == cls.SCHEMA


def test_a_service_holds_its_messages() -> None:
    """A service class has the classes of its parts."""
    cls: Any = registry.interface_class("example_interfaces/srv/AddTwoInts")
    assert issubclass(cls, base.Service)
    assert cls.NAME == "example_interfaces/srv/AddTwoInts"
    assert cls.Request is registry.interface_class("example_interfaces/srv/AddTwoInts_Request")
    assert cls.Response(sum=5).sum == 5
    assert [f.name for f in cls.Event.SCHEMA.fields] == ["info", "request", "response"]


def test_an_action_holds_its_messages() -> None:
    """An action class has the classes of its parts."""
    cls: Any = registry.interface_class("example_interfaces/action/Fibonacci")
    assert issubclass(cls, base.Action)
    assert cls.NAME == "example_interfaces/action/Fibonacci"
    assert (cls.Goal(order=3).order, cls.Result().sequence.tolist(), cls.Feedback().sequence.tolist()) == (3, [], [])
    assert cls.Goal is registry.interface_class("example_interfaces/action/Fibonacci_Goal")


def test_zeros_where_nothing_else_is_said() -> None:
    """Without a default a number is zero, a string and a sequence empty, a nested message its own default."""
    message = make("test_msgs/msg/BasicTypes")
    values = {f.name: getattr(message, f.name) for f in message.SCHEMA.fields}
    assert set(values.values()) == {0}
    assert type(values["bool_value"]) is bool
    assert type(values["float64_value"]) is float
    assert make("std_msgs/msg/Header") == make("std_msgs/msg/Header", stamp={"sec": 0, "nanosec": 0}, frame_id="")


def test_fixed_arrays_have_their_length() -> None:
    """A fixed array without a default has its length, of every element type, bools included."""
    message = make("test_msgs/msg/Arrays")
    for field in message.SCHEMA.fields:
        if field.type.array:
            assert len(getattr(message, field.name)) == 3
    assert message.bool_values.tolist() == [False] * 3
    assert message.string_values == [""] * 3
    assert message.basic_types_values == [make("test_msgs/msg/BasicTypes")] * 3
    assert message.basic_types_values[0] is not message.basic_types_values[1]


@pytest.mark.parametrize("name", ["test_msgs/msg/Arrays", "test_msgs/msg/BoundedSequences"])
def test_array_defaults(name: str) -> None:
    """An array's default is that of its definition, to the last integer of its type."""
    message = make(name)
    assert message.bool_values_default.tolist() == [False, True, False]
    assert message.float32_values_default.tolist() == [1.125, 0.0, -1.125]
    assert message.uint64_values_default.tolist() == [0, 1, 2**64 - 1]
    assert message.int64_values_default.tolist() == [0, 2**63 - 1, -(2**63)]
    assert message.string_values_default == ["", "max value", "min value"]


def test_scalar_defaults() -> None:
    """A field's default is that of its definition, quotes and wide characters included."""
    numbers = make("test_msgs/msg/Defaults")
    assert (numbers.bool_value, numbers.byte_value, numbers.int64_value, numbers.float32_value) == (
        True,
        50,
        -40_000_000,
        1.125,
    )
    strings = make("test_msgs/msg/Strings")
    assert [getattr(strings, f"bounded_string_value_default{i}") for i in range(1, 6)] == [
        "Hello world!",
        "Hello'world!",
        'Hello"world!',
        "Hello'world!",
        'Hello"world!',
    ]
    assert make("test_msgs/msg/WStrings").wstring_value_default3 == "ハローワールド"


def test_constants_are_attributes_of_the_class() -> None:
    """A constant is read from the class or a message, with its value's type."""
    cls: Any = registry.interface_class("test_msgs/msg/Constants")
    assert (cls.BOOL_CONST, cls.FLOAT64_CONST, cls().UINT64_CONST) == (True, 1.125, 50_000_000)


def test_defaults_are_not_shared() -> None:
    """Changing one message's lists, arrays and nested messages leaves the next message's defaults alone."""
    for name, change in (
        ("test_msgs/msg/Arrays", lambda m: m.float64_values_default.fill(9)),
        ("test_msgs/msg/Arrays", lambda m: m.string_values_default.append("x")),
        ("test_msgs/msg/BoundedSequences", lambda m: m.string_values.append("x")),
        ("geometry_msgs/msg/Twist", lambda m: setattr(m.linear, "x", 5.0)),
    ):
        first, second = make(name), make(name)
        change(first)
        assert first != second
        assert second == make(name)


def test_fields_are_given_by_keyword() -> None:
    """Positional values, which a change of the definition would shuffle, are refused."""
    cls: Any = registry.interface_class("geometry_msgs/msg/Point")
    with pytest.raises(TypeError):
        cls(1.0)


def test_fields_may_be_called_like_anything(save: Save) -> None:
    """No field name collides with what the constructor itself is made of."""
    names = ["self", "absent", "convert", "f0", "d0", "m", "p", "s", "e", "o", "buf", "parts", "new", "size", "name"]
    save("clashes/msg/Part", "float32 x")
    save("clashes/msg/Names", "".join(f"Part {n}\nuint8 {n}_number\nPart[] {n}_list\n" for n in names))
    given = {n: {"x": 1} for n in names}
    cls: Any = registry.interface_class("clashes/msg/Names")
    message = cls(**given, self_number=5)
    assert cls.from_bytes(message.to_bytes()) == message
    assert (message.self.x, message.self_number, message.absent.x) == (1.0, 5, 1.0)


@pytest.mark.parametrize(
    ("package", "first", "second"),
    [
        ("cycle_of_one", "", "First first"),
        ("cycle_of_two", "Second second", "First first"),
        ("cycle_in_list", "Second[] second", "First[] first"),
    ],
)
def test_a_message_cannot_contain_itself(save: Save, package: str, first: str, second: str) -> None:
    """Definitions that contain each other are an InterfaceError with the circle, not endless work."""
    save(f"{package}/msg/First", first or "First[<=2] first")
    save(f"{package}/msg/Second", second)
    save(f"{package}/msg/Outer", "Second[] seconds")
    for name in ("Second", "Outer"):
        with pytest.raises(InterfaceError, match=f"cannot contain itself: {package}/msg/(First|Second) in"):
            registry.interface_class(f"{package}/msg/{name}")


def test_schemas_without_fields_make_classes() -> None:
    """A message without fields is made, printed and compared like others."""
    cls: Any = registry.interface_class("std_msgs/msg/Empty")
    assert Message("std_msgs/msg/Empty") == cls.SCHEMA
    assert cls.__doc__ == "std_msgs/msg/Empty: no fields."
    with pytest.raises(TypeError):
        cls(x=1)
