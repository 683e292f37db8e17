"""Context managers that do nothing until they are entered: a forgotten `async with` is told with its line."""

from __future__ import annotations

import logging
from contextlib import AbstractAsyncContextManager
from typing import TYPE_CHECKING, NoReturn, TypeVar

from graphflow.runtime.call_site import here

T = TypeVar("T", covariant=True)

logger = logging.getLogger("graphflow")


class Unentered(AbstractAsyncContextManager[T]):
    """A context manager that has something to lose.

    Args:
        way: How it is written.
    """

    def __init__(self, way: str) -> None:
        self._way = way
        self._place = here()
        self._is_known = False
        """Whether it has been entered, or was told not to be."""

    def __del__(self) -> None:
        if not getattr(self, "_is_known", True):  # True where an argument was refused
            logger.error("%s: this does nothing until it is entered; write %s", self._place, self._way)

    if not TYPE_CHECKING:  # type checkers must go on seeing what is not there

        def _refuse(self) -> NoReturn:
            self._is_known = True
            raise TypeError(f"write {self._way}")

        __await__ = __enter__ = _refuse

        def __exit__(self, *_: object) -> None:
            """There is nothing to leave: `__enter__` has refused."""
