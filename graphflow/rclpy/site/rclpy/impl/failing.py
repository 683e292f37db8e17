"""The error by which a program ends, seen from what it still runs on its way out."""

from __future__ import annotations

import sys


def failure() -> BaseException | None:
    """Return the error that is being handled, or that has ended the program; None for none.

    After an uncaught error only `sys.last_value` is left: the interpreter sets it when it prints the traceback.
    """
    return sys.exc_info()[1] or getattr(sys, "last_value", None)
