"""Arrays of messages that are handed to readers in the same process, without copying them where that is safe.

Who has published a message may go on changing it, and receivers must not notice. So an array is shared only if nobody
can write to it: it is read-only down to its memory, as that of every received message, or the message alone holds it.
In the second case it is made read-only and *lent*: the message keeps it aside, and the first time that somebody touches
the field again the message gets a copy of its own (`Message.__getattr__`). Everything else is copied.
"""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy import ndarray

from graphflow.wire.cdr.arrays import DTYPES, as_array
from graphflow.wire.cdr.unchecked import LENT

SMALL = 4096
"""Bytes up to which an array is copied in any case: it costs less than finding out."""


def lend(message: Any, name: str, base: str) -> ndarray[Any, Any]:
    """The array in a field: read-only, and of one dimension, as it would be received.

    Args:
        base: The ROS type of its elements.

    Raises:
        ValueError: An element is of another kind or does not fit.
    """
    try:
        array = object.__getattribute__(message, name)
    except AttributeError:  # lent before, and not touched since
        lent: ndarray[Any, Any] = object.__getattribute__(message, LENT)[name]
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


def _set_aside(message: Any, name: str, array: ndarray[Any, Any]) -> ndarray[Any, Any]:
    delattr(message, name)
    lent = getattr(message, LENT) or {}
    lent[name] = array
    setattr(message, LENT, lent)
    return array.reshape(-1)


def _is_frozen(array: ndarray[Any, Any]) -> bool:
    """Whether nobody can write to an array's memory."""
    while array.__class__ is ndarray:
        if array.flags.writeable:
            return False
        if array.base is None:
            return True
        array = array.base
    return isinstance(array, bytes)


def _freeze(array: ndarray[Any, Any]) -> None:
    if array.base is not None:
        array.base.flags.writeable = False
    array.flags.writeable = False


def _holders(message: Any, name: str) -> tuple[int, int]:
    """How many references there are to an array in a message, and to the one whose memory it shares.

    It reads the array itself: since 3.14 what a caller passes on counts in some functions and not in others.
    """
    array = object.__getattribute__(message, name)
    base = array.base
    return sys.getrefcount(array), 0 if base is None else sys.getrefcount(base)


def _is_held_once(array: ndarray[Any, Any], holders: tuple[int, int]) -> bool:
    """Whether only the message that the array comes from holds it, and nobody else the memory beneath."""
    base = array.base
    if base is None:
        return bool(array.flags.owndata) and holders[0] <= _OWNER_ALONE[0]
    is_owner = base.__class__ is ndarray and base.base is None and base.flags.owndata
    return is_owner and holders[0] <= _VIEW_ALONE[0] and holders[1] <= _VIEW_ALONE[1]


def _holders_in_a_message(array: ndarray[Any, Any]) -> tuple[int, int]:
    """What `_holders` finds, as `lend` calls it, where only a message holds the array."""
    return _holders(SimpleNamespace(data=array), "data")


_OWNER_ALONE = _holders_in_a_message(np.zeros(1))
_VIEW_ALONE = _holders_in_a_message(np.zeros(1).reshape(-1))
