"""Conditions on messages that are typed on the command line, as in `--filter 'm.data > 3'`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from graphflow.errors import UsageFault


def compiled(expression: str) -> Callable[[Any], bool]:
    """A condition on a message `m`, in Python: what is typed here runs here, as in ROS 2.

    Raises:
        UsageFault: It is no expression.
    """
    try:
        code = compile(expression, "--filter", "eval")
    except (SyntaxError, ValueError) as error:
        raise UsageFault(f"--filter {expression!r} is no expression: {error}; write for example 'm.data > 3'") from None

    def holds(message: Any) -> bool:
        try:
            return bool(eval(code, {"m": message}))  # noqa: S307 - the user's own, on the user's own command line
        except NameError as error:
            field = f"; write m.{error.name}" if error.name in dir(message) else "; the message is m, as in m.data > 3"
            raise UsageFault(f"--filter {expression!r}: {error}{field}") from None
        except Exception as error:
            raise UsageFault(f"--filter {expression!r}: {type(error).__name__}: {error}") from None

    return holds
