"""Sharing arrays with readers in the same process, without a copy where that is safe.

A publisher may go on changing a message, and receivers must not notice. So an array is shared only if nobody can write
to it: it is read-only down to its memory, as in every received message, or the message has the only reference to it.
In the second case it becomes read-only and is *lent*: the message sets it aside, and the first access to the field
after that gives the message a copy of its own (`Message.__getattr__`). All other arrays are copied.
"""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy import ndarray

from graphflow.wire.cdr.arrays import DTYPES, Array, as_array
from graphflow.wire.cdr.unchecked import LENT

SMALL = 4096
"""Bytes up to which an array is copied in any case, which costs less than finding out."""


def lend(message: Any, name: str, base: str) -> Array:
    """Return the array of a field for receivers: read-only and one-dimensional.

    Args:
        base: The ROS type of its elements.

    Raises:
        ValueError: An element has another kind or does not fit.
    """
    try:
        array = object.__getattribute__(message, name)
    except AttributeError:  # lent before, and not accessed since
        lent: Array = object.__getattribute__(message, LENT)[name]
        return lent.reshape(-1)
    if array.__class__ is not ndarray or array.dtype != DTYPES[base] or not array.flags.c_contiguous:
        array = as_array(array, base)
    elif array.nbytes > SMALL and hasattr(type(message), LENT):
        holders = _holders(message, name)
        if _is_held_once(array, holders):
            _freeze(array)
            return _set_aside(message, name, array)
    if array.nbytes > SMALL and _is_frozen(array):
        return array.reshape(-1)
    copy = array.copy()
    copy.flags.writeable = False
    return copy.reshape(-1)


def _set_aside(message: Any, name: str, array: Array) -> Array:
    delattr(message, name)
    lent = getattr(message, LENT) or {}
    lent[name] = array
    setattr(message, LENT, lent)
    return array.reshape(-1)


def _is_frozen(array: Array) -> bool:
    """Return whether nobody can write to an array's memory."""
    while array.__class__ is ndarray:
        if array.flags.writeable:
            return False
        if array.base is None:
            return True
        array = array.base
    return isinstance(array, bytes)


def _freeze(array: Array) -> None:
    if array.base is not None:
        array.base.flags.writeable = False
    array.flags.writeable = False


def _holders(message: Any, name: str) -> tuple[int, int]:
    """Count the references to an array in a message, and to the owner of its memory.

    It reads the field itself: since 3.14 a caller's reference is counted in some functions and not in others.
    """
    array = object.__getattribute__(message, name)
    base = array.base
    return sys.getrefcount(array), 0 if base is None else sys.getrefcount(base)


def _is_held_once(array: Array, holders: tuple[int, int]) -> bool:
    """Return whether only the message refers to an array, and nobody else to its memory."""
    base = array.base
    if base is None:
        return bool(array.flags.owndata) and holders[0] <= _OWNER_ALONE[0]
    is_owner = base.__class__ is ndarray and base.base is None and base.flags.owndata
    return is_owner and holders[0] <= _VIEW_ALONE[0] and holders[1] <= _VIEW_ALONE[1]


def _holders_in_a_message(array: Array) -> tuple[int, int]:
    """Return the count of `_holders`, as `lend` calls it, for an array that only a message refers to."""
    return _holders(SimpleNamespace(data=array), "data")


_OWNER_ALONE = _holders_in_a_message(np.zeros(1))
_VIEW_ALONE = _holders_in_a_message(np.zeros(1).reshape(-1))
