"""Names, code and places of the callables that users pass."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from types import CodeType, FunctionType, MethodType

from graphflow.errors import Place


def name_of(fn: object, default: str = "") -> str:
    """Return a callable's name; for one without, such as a `functools.partial`, the default or else its repr."""
    name = getattr(fn, "__name__", None)
    return name if isinstance(name, str) else default or repr(fn)


def code_of(fn: object) -> CodeType | None:
    """Return the code of a function or method; None for a callable that is not written in Python."""
    function = fn.__func__ if isinstance(fn, (MethodType, classmethod, staticmethod)) else fn
    return function.__code__ if isinstance(function, FunctionType) else None


def written_at(fn: Callable[..., object]) -> str:
    """Return the place of a function as `file:line`, decorators left aside; "" if it is not written in Python."""
    code = code_of(inspect.unwrap(fn))
    return "" if code is None else str(Place(code.co_filename, code.co_firstlineno))


def file_of(module: object) -> str | None:
    """Return a module's file; None for a built-in one, or for another object in `sys.modules`."""
    file = getattr(module, "__file__", None)
    return file if isinstance(file, str) else None
