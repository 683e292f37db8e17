"""Conditions on messages, given on the command line: `--filter 'm.data > 3'`."""

from __future__ import annotations

from collections.abc import Callable

from graphflow.errors import UsageFault


def compile_condition(expression: str) -> Callable[[object], bool]:
    """Compile a condition on a message `m`, a Python expression that is evaluated as in ROS 2.

    Raises:
        UsageFault: It is not an expression; or, when called, it fails.
    """
    try:
        code = compile(expression, "--filter", "eval")
    except (SyntaxError, ValueError) as error:
        words = {"&&": "and", "||": "or"}
        meant = next((f"write {word} for {sign}" for sign, word in words.items() if sign in expression), "")
        example = meant or "example: 'm.data > 3'"
        raise UsageFault(f"--filter {expression!r} is not an expression: {error}; {example}") from None

    def holds(message: object) -> bool:
        try:
            return bool(eval(code, {"m": message}))  # noqa: S307 - typed by the user who runs it
        except NameError as error:
            field = f"; write m.{error.name}" if error.name in dir(message) else "; the message is m, as in m.data > 3"
            raise UsageFault(f"--filter {expression!r}: {error}{field}") from None
        except Exception as error:  # the user's expression may raise anything
            raise UsageFault(f"--filter {expression!r}: {type(error).__name__}: {error}") from None

    return holds
