"""The base classes of messages, services and actions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, Generic, Self, TypeVar

from msgspec import Struct

from graphflow.names import did_you_mean
from graphflow.wire.cdr.codec import Codec
from graphflow.wire.cdr.unchecked import LENT, unchecked
from graphflow.wire.schema import Message as Schema


def lent_or_missing(self: Message, name: str) -> object:
    """Copy a field that was lent to receivers (see `wire.cdr.lending`): `__getattr__` of messages with arrays.

    Other classes have no `__getattr__`: on Python 3.11 it makes each access to a field seven times slower.

    Raises:
        AttributeError: There is no such field.
    """
    lent = None if name == LENT else self._lent  # type: ignore[attr-defined]  # of messages with arrays
    if lent is None or name not in lent:
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)
    setattr(self, name, lent.pop(name).copy())
    return object.__getattribute__(self, name)


def copy_of_arrays(self: Message) -> Message:
    """Copy a message with its lent arrays: `__copy__` of messages with arrays."""
    copy: Message = unchecked(*self.__reduce__()[1])
    return copy


class Message(Struct, eq=False):
    """A ROS 2 message. Classes are built from definitions; see `graphflow.msgs`.

    The constructor takes fields by keyword, checks them, and widens: integers for floats, sequences for arrays,
    mappings or objects with the same fields for nested messages. Assignment does not check; a value that does not
    fit is reported, by its field's path, when the message is encoded.

    A field may have any lower-case name, so a message has few other attributes, under names that no known definition
    uses.
    """

    SCHEMA: ClassVar[Schema]
    NESTED: ClassVar[Mapping[str, type[Message]]]
    """Classes of nested message types, by name."""
    CODEC: ClassVar[Callable[[], Codec]]
    """Returns the compiled codec."""

    def to_bytes(self) -> bytes:
        """Encode the message as CDR with its 4-byte header.

        Raises:
            EncodeError: A field has a value that its type cannot carry; the text begins with the field's path.
        """
        return type(self).CODEC().encode(self)

    @classmethod
    def from_bytes(cls, payload: bytes) -> Self:
        """Decode a message from CDR. Its arrays are read-only views of `payload`.

        Raises:
            DecodeError: `payload` is not a message of this type.
        """
        message: Self = cls.CODEC().decode(payload)
        return message

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Return field names and types as ROS 2 prints them."""
        return {f.name: str(f.type).replace("/msg/", "/") for f in cls.SCHEMA.fields}

    def __eq__(self, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return all(_same(getattr(self, f.name), getattr(other, f.name)) for f in self.SCHEMA.fields)

    __hash__ = None  # type: ignore[assignment]  # messages are mutable

    def __repr__(self) -> str:
        values = ", ".join(f"{f.name}={_text(getattr(self, f.name))}" for f in self.SCHEMA.fields)
        return f"{self.SCHEMA.name.replace('/', '.')}({values})"

    def __reduce__(self) -> tuple[Any, ...]:
        # Not through the constructor: a received message can break a bound, and is copied unchanged.
        return unchecked, (type(self), *(getattr(self, f.name) for f in self.SCHEMA.fields))


def name_of(cls: type[Message]) -> str:
    """Return the written name of a message class: `Fibonacci.Goal` for a part of an action."""
    return ".".join(cls.__name__.rsplit("_", 1))


def made_as(cls: type[Message]) -> str:
    """Return the expression that creates a message: `Fibonacci.Feedback(sequence=...)`."""
    first = f"{cls.SCHEMA.fields[0].name}=..." if cls.SCHEMA.fields else ""
    return f"{name_of(cls)}({first})"


def no_field(cls: type[Message], name: str) -> str:
    """Return the error text for a field that a message does not have."""
    fields = {f.name: f"{f.type} {f.name}" for f in cls.SCHEMA.fields}
    hint = did_you_mean(name, fields) or f"; its fields: {', '.join(fields.values()) or 'none'}"
    return f"{name_of(cls)} has no field {name!r}{hint}"


def _same(a: Any, b: Any) -> bool:
    if hasattr(a, "tolist") or hasattr(b, "tolist"):
        return len(a) == len(b) and bool((a == b).all() if hasattr(a, "tolist") else (b == a).all())
    return bool(a == b)


def _text(value: Any) -> str:
    if hasattr(value, "tolist"):
        return f"array({value.tolist()})" if value.size <= 16 else f"array({value[:16].tolist()[:-1]}..., {value.size})"
    return repr(value)


Request = TypeVar("Request", bound=Message)
Response = TypeVar("Response", bound=Message)
Goal = TypeVar("Goal", bound=Message)
Result = TypeVar("Result", bound=Message)
Feedback = TypeVar("Feedback", bound=Message)


class Service(Generic[Request, Response]):
    """A ROS 2 service type: `Request`, `Response` and `Event` are its message classes."""

    NAME: ClassVar[str]
    Event: ClassVar[type[Message]]

    def __new__(cls, *_: object, **__: object) -> Self:
        """Raise TypeError: a service type has no instances."""
        raise TypeError(
            f"{cls.__name__} is a service; create {cls.__name__}.Request(...) or {cls.__name__}.Response(...)"
        )


class ServerGoalHandle(ABC, Generic[Goal, Result, Feedback]):
    """A goal for the handler of an action.

    Attributes:
        request: The client's goal message.
        partial: The result so far, which the client gets if the goal is cancelled or aborted.
    """

    request: Goal
    partial: Result

    @property
    @abstractmethod
    def goal_id(self) -> bytes:
        """The goal's id: 16 bytes, chosen by the client."""

    @property
    @abstractmethod
    def is_preempted(self) -> bool:
        """Whether the goal must end because a newer one has arrived."""

    @property
    @abstractmethod
    def is_cancel_requested(self) -> bool:
        """Whether the goal must end; for handlers in threads. On the loop, `CancelledError` is raised instead."""

    @abstractmethod
    def feedback(self, feedback: Feedback) -> None:
        """Send the client the progress of the goal. Never waits."""


class Action(Generic[Goal, Result, Feedback]):
    """A ROS 2 action type: `Goal`, `Result` and `Feedback` are its message classes, `Handle` its `ServerGoalHandle`."""

    NAME: ClassVar[str]

    def __new__(cls, *_: object, **__: object) -> Self:
        """Raise TypeError: an action type has no instances."""
        raise TypeError(f"{cls.__name__} is an action; create {cls.__name__}.Goal(...), .Result(...) or .Feedback(...)")
