"""Exit codes: 0 ok, 1 failed, 2 wrong usage or graph file, 3 nothing running, 4 timeout."""

from __future__ import annotations

from graphflow.errors import (
    CallTimeout,
    EncodeError,
    GraphFileError,
    GraphflowError,
    InterfaceError,
    InvalidName,
    SupervisorError,
    UsageFault,
)

OK, FAILED, USAGE, NOT_RUNNING, TIMEOUT = range(5)


def exit_code(error: GraphflowError) -> int:
    """Return the exit code of a command that raised `error`."""
    if isinstance(error, SupervisorError):
        return error.exit_code
    if isinstance(error, CallTimeout):
        return TIMEOUT
    if isinstance(error, (GraphFileError, UsageFault, InterfaceError, InvalidName, EncodeError)):
        return USAGE
    return FAILED
