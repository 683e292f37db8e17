"""Message classes: constructors, defaults and conversions."""

from __future__ import annotations

from collections import OrderedDict
from types import MappingProxyType, SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from graphflow.errors import EncodeError, InterfaceError
from graphflow.msgs import base, registry
from graphflow.msgs.values import checked
from graphflow.times import Duration, Time
from graphflow.wire.schema import INTEGER_RANGES, Message

if TYPE_CHECKING:
    from .conftest import Save


def make(name: str, **fields: Any) -> Any:
    return registry.interface_class(name)(**fields)


def test_a_class_is_where_it_is_imported_from() -> None:
    """A class knows its module, its name, its schema, and what it holds."""
    cls = registry.interface_class("geometry_msgs/msg/Point")
    assert (cls.__module__, cls.__name__) == ("graphflow.msgs.geometry_msgs.msg", "Point")
    assert cls.__doc__ == "geometry_msgs/msg/Point: float64 x, float64 y, float64 z."
    assert issubclass(cls, base.Message)
    assert cls.SCHEMA is registry.message_schema("geometry_msgs/msg/Point")


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
    with pytest.raises(TypeError, match="positional"):
        cls(1.0)


@pytest.mark.parametrize(
    "value",
    [{"x": 1, "z": 3}, OrderedDict(x=1, z=3.0), MappingProxyType({"x": 1, "z": 3}), SimpleNamespace(x=1, y=0, z=3)],
)
def test_nested_messages_from_mappings_and_objects(value: Any) -> None:
    """A nested message is given as a mapping, in which fields may be missing, or as any object with its fields."""
    twist = make("geometry_msgs/msg/Twist", linear=value)
    assert twist.linear == make("geometry_msgs/msg/Vector3", x=1.0, y=0.0, z=3.0)


def test_times_fit_their_messages() -> None:
    """A `times.Time` or `times.Duration` is taken for the message of that name."""
    header = make("std_msgs/msg/Header", stamp=Time(1_500_000_000))
    assert (header.stamp.sec, header.stamp.nanosec) == (1, 500_000_000)
    status = make("tf2_msgs/action/LookupTransform_Goal", timeout=Duration(-1))
    assert (status.timeout.sec, status.timeout.nanosec) == (-1, 999_999_999)


def test_a_nested_message_is_not_copied() -> None:
    """A message of the right class becomes part of the new one as it is."""
    vector = make("geometry_msgs/msg/Vector3")
    assert make("geometry_msgs/msg/Twist", linear=vector).linear is vector


def test_a_message_of_another_type_is_no_nested_message() -> None:
    """A message of another type is refused, though its fields have the same names."""
    with pytest.raises(
        EncodeError, match=r"^Twist\.linear: expected geometry_msgs/msg/Vector3, got geometry_msgs.msg.Po"
    ):
        make("geometry_msgs/msg/Twist", linear=make("geometry_msgs/msg/Point"))


def test_an_unknown_field_is_helped() -> None:
    """A mapping with a misspelt field is refused with the nearest one."""
    with pytest.raises(EncodeError, match=r"^Header\.stamp: .* has no field 'nanosecs'; did you mean 'nanosec'\?$"):
        make("std_msgs/msg/Header", stamp={"nanosecs": 5})


def test_the_path_leads_through_lists_and_mappings() -> None:
    """A fault deep inside what was given is reported by its whole path."""
    poses = [{"position": {"x": 1}}, {"orientation": {"w": "up"}}]
    with pytest.raises(EncodeError, match=r"^PoseArray\.poses\[1\]\.orientation\.w: expected float64, got 'up'$"):
        make("geometry_msgs/msg/PoseArray", poses=poses)


@pytest.mark.parametrize("base_type", sorted(INTEGER_RANGES))
def test_bools_and_floats_are_no_integers(base_type: str) -> None:
    """An integer field takes neither True nor 1.0, as these are likely mistakes."""
    for value in (True, 1.0, np.float64(1), np.bool_(True), "1"):
        with pytest.raises(EncodeError, match=f"expected {base_type}, got"):
            make("test_msgs/msg/BasicTypes", **{f"{base_type}_value": value})


@pytest.mark.parametrize("value", [0, 1, 1.0, "true", None])
def test_numbers_are_no_bools(value: Any) -> None:
    """A bool field takes True and False only."""
    with pytest.raises(EncodeError, match="expected bool, got"):
        make("std_msgs/msg/Bool", data=value)


def test_floats_keep_their_kind() -> None:
    """An integer or numpy scalar in a float field becomes a Python float at once."""
    for value in (1, np.int8(1), np.float32(1)):
        assert type(make("std_msgs/msg/Float32", data=value).data) is float


@pytest.mark.parametrize("value", [float("inf"), float("-inf"), float("nan"), 3.4028234e38])
def test_every_float32_fits_float32(value: float) -> None:
    """Infinities, NaN and the largest float32 are values of float32."""
    assert repr(make("std_msgs/msg/Float32", data=value).data) == repr(value)
    make("std_msgs/msg/Float32", data=value).to_bytes()


def test_an_array_is_taken_as_it_is() -> None:
    """A numpy array of the right type is not copied."""
    array = np.zeros(5, np.float32)
    assert np.shares_memory(make("std_msgs/msg/Float32MultiArray", data=array).data, array)


def test_bounds_hold_exactly() -> None:
    """Strings and sequences may be as long as their bound."""
    message = make("odd_shapes/msg/Bounds", short="five!", wide="abc", labels=["four", ""], numbers=[1, 2, 3])
    assert type(message).from_bytes(message.to_bytes()) == message


def test_checked_copies_and_converts() -> None:
    """`checked` gives a message with every value converted, and leaves the one given alone."""
    message = make("geometry_msgs/msg/Twist")
    message.linear = {"x": 1}
    copy = checked(message)
    assert copy == make("geometry_msgs/msg/Twist", linear={"x": 1.0})
    assert message.linear == {"x": 1}
    assert copy.angular is not message.angular  # type: ignore[attr-defined]


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
