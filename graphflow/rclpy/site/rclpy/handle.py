"""Handles of entities, which in rclpy wrap rcl objects: in use, then destroyed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Self

from graphflow.errors import ClosedError
from rclpy._rclpy_pybind11 import InvalidHandle, RCLError


class Handle:
    """The handle of an entity until it is destroyed.

    Args:
        withdraw: Called once, when the handle is destroyed.
        more: Further attributes that programs read from such a handle.
    """

    def __init__(self, withdraw: Callable[[], None], **more: object) -> None:
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
        """Raise RCLError if the network was left meanwhile; uses are not counted."""
        if isinstance(error, ClosedError):
            raise _left(error) from None

    def destroy_when_not_in_use(self) -> None:
        """Destroy the handle. Idempotent."""
        withdraw, self._withdraw = self._withdraw, None
        if withdraw is not None:
            withdraw()


@contextmanager
def sending() -> Iterator[None]:
    """Guard a send. Raises RCLError if the network was left meanwhile."""
    try:
        yield
    except ClosedError as error:
        raise _left(error) from None


def _left(error: ClosedError) -> RCLError:
    return RCLError(f"the context was shut down: {error}")
