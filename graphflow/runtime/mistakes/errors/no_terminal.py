"""Advice on `input()` in a node that has no terminal, as the nodes of a graph, whose standard input is `/dev/null`."""

from __future__ import annotations

import os
from contextlib import suppress


def advise_on_input(error: BaseException, read: str = "") -> str:
    """Return advice on an error of `input()` where standard input is `/dev/null`; "" for any other.

    Args:
        read: The rest of the advice: how such a node reads its terminal.
    """
    if type(error) is not EOFError or str(error) != "EOF when reading a line" or not _is_null(0):
        return ""
    return f"a node of a graph has no terminal: start it by itself, in a terminal of its own, with graphflow run{read}"


def _is_null(descriptor: int) -> bool:
    """Whether a descriptor is `/dev/null`, rather than a file or pipe that has ended."""
    with suppress(OSError):
        return os.path.samestat(os.fstat(descriptor), os.stat(os.devnull))
    return False
