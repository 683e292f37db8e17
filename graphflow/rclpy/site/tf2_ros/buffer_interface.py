"""The interface of all buffers, which transforms objects with a frame."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, TypeAlias, TypeVar

from rclpy.duration import Duration
from rclpy.time import Time

K = TypeVar("K")
Conversion: TypeAlias = Callable[..., Any]
"""A function that converts or transforms objects; only its caller knows their types."""
AT_ONCE = Duration()
"""The timeout that does not wait."""


class NotImplementedException(Exception):
    """A buffer does not implement the method."""

    def __init__(self) -> None:
        super().__init__("CanTransform or LookupTransform not implemented")


class TypeException(Exception):
    """No function is registered to transform, or to convert, an object of that type."""


class Stamped:
    """An object with its time and frame."""

    def __init__(self, obj: object, stamp: object, frame_id: str) -> None:
        self.obj, self.stamp, self.frame_id = obj, stamp, frame_id


class TransformRegistration:
    """The functions that transform objects, by type: `fn(object, transform_stamped)` each."""

    _known: ClassVar[dict[type, Conversion]] = {}

    def add(self, key: type, callback: Conversion) -> None:
        self._known[key] = callback

    def get(self, key: type) -> Conversion:
        """Return the function for a type. Raises TypeException if there is none."""
        try:
            return self._known[key]
        except KeyError:
            raise TypeException(
                f"Type {key} is not loaded or supported: does the program import tf2_geometry_msgs?"
            ) from None


class ConvertRegistration:
    """The functions that convert objects to messages and back, and between messages; by type."""

    _to: ClassVar[dict[type, Conversion]] = {}
    _from: ClassVar[dict[type, Conversion]] = {}
    _between: ClassVar[dict[tuple[type, type], Conversion]] = {}

    def add_to_msg(self, key: type, callback: Conversion) -> None:
        self._to[key] = callback

    def add_from_msg(self, key: type, callback: Conversion) -> None:
        self._from[key] = callback

    def add_convert(self, key: tuple[type, type], callback: Conversion) -> None:
        self._between[key] = callback

    def get_to_msg(self, key: type) -> Conversion:
        return _found(self._to, key)

    def get_from_msg(self, key: type) -> Conversion:
        return _found(self._from, key)

    def get_convert(self, key: tuple[type, type]) -> Conversion:
        return _found(self._between, key)


def _found(known: dict[K, Conversion], key: K) -> Conversion:
    try:
        return known[key]
    except KeyError:
        raise TypeException(f"Type {key} is not loaded or supported") from None


def convert(a: Any, b_type: type) -> Any:
    """Convert an object to another type, via a message. Raises TypeException."""
    registration = ConvertRegistration()
    try:
        return registration.get_convert((type(a), b_type))(a)
    except TypeException:
        if type(a) is b_type:
            return a
        return registration.get_from_msg(b_type)(registration.get_to_msg(type(a))(a))


class BufferInterface:
    """The base class of buffers; subclasses implement the lookups."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self, object_stamped: Any, target_frame: str, timeout: Duration = AT_ONCE, new_type: type | None = None
    ) -> Any:
        """Transform an object to another frame, at the time of its own stamp.

        Raises:
            TransformException, TypeException: See their docstrings.
        """
        header = object_stamped.header
        found = self.lookup_transform(target_frame, header.frame_id, Time.from_msg(header.stamp), timeout)
        return self._graphflow_apply(object_stamped, found, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: object,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
        new_type: type | None = None,
    ) -> Any:
        """Transform an object to another frame at another time. Raises TransformException, TypeException."""
        header = object_stamped.header
        stamp = Time.from_msg(header.stamp)
        found = self.lookup_transform_full(target_frame, target_time, header.frame_id, stamp, fixed_frame, timeout)
        return self._graphflow_apply(object_stamped, found, new_type)

    def _graphflow_apply(self, object_stamped: object, found: Any, new_type: type | None) -> object:
        moved = self.registration.get(type(object_stamped))(object_stamped, found)
        return moved if new_type is None else convert(moved, new_type)

    def lookup_transform(self, target_frame: str, source_frame: str, time: object, timeout: Duration = AT_ONCE) -> Any:
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
    ) -> Any:
        raise NotImplementedException

    def can_transform(self, target_frame: str, source_frame: str, time: object, timeout: Duration = AT_ONCE) -> Any:
        raise NotImplementedException

    def can_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
    ) -> Any:
        raise NotImplementedException
