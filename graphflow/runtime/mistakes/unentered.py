"""Context managers that must be entered: a forgotten `async with` is reported with its line."""

from __future__ import annotations

import inspect
import logging
import sys
from contextlib import AbstractAsyncContextManager
from typing import TYPE_CHECKING, NoReturn, TypeVar

from graphflow.runtime.call_site import here

T = TypeVar("T", covariant=True)

logger = logging.getLogger("graphflow")


class Unentered(AbstractAsyncContextManager[T]):
    """A context manager that has no effect unless entered.

    Args:
        way: The correct form.
    """

    def __init__(self, way: str) -> None:
        self._way = way
        self._place = here()
        self._is_known = False
        """Whether it was entered, or an error was raised about it."""

    def __del__(self) -> None:
        if not getattr(self, "_is_known", True):  # True if the constructor refused its arguments
            logger.error("%s: this has no effect until it is entered; write %s", self._place, self._way)

    if not TYPE_CHECKING:  # type checkers must keep reporting unknown attributes

        def __await__(self) -> NoReturn:
            self._is_known = True
            raise TypeError(f"write {self._way}")

        def __enter__(self) -> NoReturn:
            self._is_known = True
            caller = sys._getframe(1).f_code
            is_async = caller.co_flags & (inspect.CO_COROUTINE | inspect.CO_ASYNC_GENERATOR)
            where = "" if is_async else ", in an async def main(), which asyncio.run(main()) runs"
            raise TypeError(f"write {self._way}{where}")

        def __exit__(self, *_: object) -> None:
            """Do nothing: `__enter__` has raised."""
