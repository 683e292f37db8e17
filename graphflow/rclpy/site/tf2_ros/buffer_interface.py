"""What all buffers can do with objects that are in a frame."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from rclpy.duration import Duration
from rclpy.time import Time

AT_ONCE = Duration()
"""Does not wait."""


class NotImplementedException(Exception):
    """A buffer does not do that."""

    def __init__(self) -> None:
        super().__init__("CanTransform or LookupTransform not implemented")


class TypeException(Exception):
    """Nobody has said how to transform, or to convert, an object of that type."""


class Stamped:
    """An object, when it was there, and in which frame."""

    def __init__(self, obj: Any, stamp: Any, frame_id: str) -> None:
        self.obj, self.stamp, self.frame_id = obj, stamp, frame_id


class TransformRegistration:
    """How objects are transformed, by type: `fn(object, transform_stamped)` each."""

    _known: ClassVar[dict[type, Callable[[Any, Any], Any]]] = {}

    def add(self, key: type, callback: Callable[[Any, Any], Any]) -> None:
        self._known[key] = callback

    def get(self, key: type) -> Callable[[Any, Any], Any]:
        """Raises TypeException: There is none."""
        try:
            return self._known[key]
        except KeyError:
            raise TypeException(
                f"Type {key} is not loaded or supported: does the program import tf2_geometry_msgs?"
            ) from None


class ConvertRegistration:
    """How objects become messages and back, and one message another; by type."""

    _to: ClassVar[dict[type, Callable[[Any], Any]]] = {}
    _from: ClassVar[dict[type, Callable[[Any], Any]]] = {}
    _between: ClassVar[dict[tuple[type, type], Callable[[Any], Any]]] = {}

    def add_to_msg(self, key: type, callback: Callable[[Any], Any]) -> None:
        self._to[key] = callback

    def add_from_msg(self, key: type, callback: Callable[[Any], Any]) -> None:
        self._from[key] = callback

    def add_convert(self, key: tuple[type, type], callback: Callable[[Any], Any]) -> None:
        self._between[key] = callback

    def get_to_msg(self, key: type) -> Callable[[Any], Any]:
        return _found(self._to, key)

    def get_from_msg(self, key: type) -> Callable[[Any], Any]:
        return _found(self._from, key)

    def get_convert(self, key: tuple[type, type]) -> Callable[[Any], Any]:
        return _found(self._between, key)


def _found(known: dict[Any, Callable[[Any], Any]], key: Any) -> Callable[[Any], Any]:
    try:
        return known[key]
    except KeyError:
        raise TypeException(f"Type {key} is not loaded or supported") from None


def convert(a: Any, b_type: type) -> Any:
    """An object as one of another type, by way of a message. Raises TypeException."""
    registration = ConvertRegistration()
    try:
        return registration.get_convert((type(a), b_type))(a)
    except TypeException:
        if type(a) is b_type:
            return a
        return registration.get_from_msg(b_type)(registration.get_to_msg(type(a))(a))


class BufferInterface:
    """A buffer whose look-ups another class has."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self, object_stamped: Any, target_frame: str, timeout: Duration = AT_ONCE, new_type: type | None = None
    ) -> Any:
        """An object with its coordinates in another frame, at the time of its own stamp.

        Raises:
            TransformException, TypeException: As they say.
        """
        header = object_stamped.header
        found = self.lookup_transform(target_frame, header.frame_id, Time.from_msg(header.stamp), timeout)
        return self._graphflow_apply(object_stamped, found, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Any,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
        new_type: type | None = None,
    ) -> Any:
        """The same at another time. Raises TransformException, TypeException."""
        header = object_stamped.header
        stamp = Time.from_msg(header.stamp)
        found = self.lookup_transform_full(target_frame, target_time, header.frame_id, stamp, fixed_frame, timeout)
        return self._graphflow_apply(object_stamped, found, new_type)

    def _graphflow_apply(self, object_stamped: Any, found: Any, new_type: type | None) -> Any:
        moved = self.registration.get(type(object_stamped))(object_stamped, found)
        return moved if new_type is None else convert(moved, new_type)

    def lookup_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Duration = AT_ONCE) -> Any:
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
    ) -> Any:
        raise NotImplementedException

    def can_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Duration = AT_ONCE) -> Any:
        raise NotImplementedException

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
    ) -> Any:
        raise NotImplementedException
