"""The schema of interfaces, from which codecs, type hashes and message classes are derived.

Source: rosidl's interface definition article; derived types as made by rosidl_generator_type_description.
"""

from __future__ import annotations

from typing import NamedTuple

INTEGER_RANGES: dict[str, tuple[int, int]] = {
    "int8": (-(2**7), 2**7 - 1),
    "uint8": (0, 2**8 - 1),
    "byte": (0, 2**8 - 1),
    "char": (0, 2**8 - 1),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
}
"""Smallest and largest value of each integer type."""

NUMERIC = frozenset({*INTEGER_RANGES, "bool", "float32", "float64"})
STRINGS = frozenset({"string", "wstring"})
PRIMITIVES = NUMERIC | STRINGS

Value = bool | int | float | str | list["Value"]
"""A default or a constant."""


def string_length(base: str, text: str) -> int:
    """Return the length that a string's bound limits: UTF-8 bytes of a `string`, UTF-16 code units of a `wstring`."""
    return len(text.encode()) if base == "string" else len(text.encode("utf-16-le", "surrogatepass")) // 2


class FieldType(NamedTuple):
    """The type of a field: `string<=5[<=10]` is base string, string_bound 5, a bounded array of 10."""

    base: str
    """The name of a primitive, or `package/msg/Name`."""
    string_bound: int = 0
    array: str = ""
    """The kind of array: empty for none, `fixed`, `bounded` or `unbounded`."""
    size: int = 0
    """N of `[N]` and `[<=N]`."""

    @property
    def is_primitive(self) -> bool:
        return self.base in PRIMITIVES

    def __str__(self) -> str:
        bound = f"<={self.string_bound}" if self.string_bound else ""
        suffix = {"": "", "fixed": f"[{self.size}]", "bounded": f"[<={self.size}]", "unbounded": "[]"}[self.array]
        return f"{self.base}{bound}{suffix}"


class Field(NamedTuple):
    name: str
    type: FieldType
    default: Value | None = None


class Constant(NamedTuple):
    name: str
    type: str
    value: bool | int | float | str


class Message(NamedTuple):
    """A message type. `name` is `package/msg/Name`, or derived, as `package/srv/Name_Request`."""

    name: str
    fields: tuple[Field, ...] = ()
    constants: tuple[Constant, ...] = ()


def _nested(name: str, type_name: str) -> Field:
    return Field(name, FieldType(type_name))


class Service(NamedTuple):
    """A service type and the four types derived from it."""

    name: str
    request: Message
    response: Message

    @property
    def event(self) -> Message:
        """The message of service introspection: the call's metadata, then request and response if known."""
        return Message(
            f"{self.name}_Event",
            (
                _nested("info", "service_msgs/msg/ServiceEventInfo"),
                Field("request", FieldType(self.request.name, 0, "bounded", 1)),
                Field("response", FieldType(self.response.name, 0, "bounded", 1)),
            ),
        )

    @property
    def whole(self) -> Message:
        """The type whose hash is in the service's keys and tokens."""
        return Message(
            self.name,
            (
                _nested("request_message", self.request.name),
                _nested("response_message", self.response.name),
                _nested("event_message", self.event.name),
            ),
        )

    @property
    def messages(self) -> tuple[Message, ...]:
        return (self.request, self.response, self.event, self.whole)


class Action(NamedTuple):
    """An action type with its derived services and messages."""

    name: str
    goal: Message
    result: Message
    feedback: Message

    @property
    def send_goal(self) -> Service:
        name = f"{self.name}_SendGoal"
        return Service(
            name,
            Message(
                f"{name}_Request",
                (_nested("goal_id", "unique_identifier_msgs/msg/UUID"), _nested("goal", self.goal.name)),
            ),
            Message(
                f"{name}_Response",
                (Field("accepted", FieldType("bool")), _nested("stamp", "builtin_interfaces/msg/Time")),
            ),
        )

    @property
    def get_result(self) -> Service:
        name = f"{self.name}_GetResult"
        return Service(
            name,
            Message(f"{name}_Request", (_nested("goal_id", "unique_identifier_msgs/msg/UUID"),)),
            Message(f"{name}_Response", (Field("status", FieldType("int8")), _nested("result", self.result.name))),
        )

    @property
    def feedback_message(self) -> Message:
        return Message(
            f"{self.name}_FeedbackMessage",
            (_nested("goal_id", "unique_identifier_msgs/msg/UUID"), _nested("feedback", self.feedback.name)),
        )

    @property
    def whole(self) -> Message:
        return Message(
            self.name,
            (
                _nested("goal", self.goal.name),
                _nested("result", self.result.name),
                _nested("feedback", self.feedback.name),
                _nested("send_goal_service", self.send_goal.name),
                _nested("get_result_service", self.get_result.name),
                _nested("feedback_message", self.feedback_message.name),
            ),
        )

    @property
    def services(self) -> tuple[Service, Service]:
        return (self.send_goal, self.get_result)

    @property
    def messages(self) -> tuple[Message, ...]:
        parts = [self.goal, self.result, self.feedback, self.feedback_message, self.whole]
        for service in self.services:
            parts += service.messages
        return tuple(parts)


Interface = Message | Service | Action
