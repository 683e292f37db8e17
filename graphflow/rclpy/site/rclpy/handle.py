"""Stands for rclpy's handles, which wrap rcl's objects: something that is in use, and then destroyed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Any, Self

from graphflow.errors import ClosedError
from rclpy._rclpy_pybind11 import InvalidHandle, RCLError


class Handle:
    """What an entity holds until it is destroyed.

    Args:
        withdraw: Called once, when it is destroyed.
        more: What code asks of such a handle besides.
    """

    def __init__(self, withdraw: Callable[[], None], **more: Any) -> None:
        self._withdraw: Callable[[], None] | None = withdraw
        self.__dict__.update(more)

    @property
    def pointer(self) -> int:
        return id(self)

    @property
    def is_destroyed(self) -> bool:
        return self._withdraw is None

    def __enter__(self) -> Self:
        if self._withdraw is None:
            raise InvalidHandle("cannot use Destroyable because destruction was requested")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Raise RCLError where the network was left meanwhile; what is in use is not counted."""
        if isinstance(error, ClosedError):
            raise _left(error) from None

    def destroy_when_not_in_use(self) -> None:
        """Destroy it. Twice is harmless."""
        withdraw, self._withdraw = self._withdraw, None
        if withdraw is not None:
            withdraw()


@contextmanager
def sending() -> Iterator[None]:
    """Send something. Raises RCLError where the network was left meanwhile."""
    try:
        yield
    except ClosedError as error:
        raise _left(error) from None


def _left(error: ClosedError) -> RCLError:
    return RCLError(f"the context was shut down: {error}")
