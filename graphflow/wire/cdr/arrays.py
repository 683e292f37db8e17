"""Numeric arrays of messages as numpy arrays. Imported only by types that have such a field."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy import ndarray

from graphflow.wire.schema import INTEGER_RANGES

__all__ = ["DTYPES", "as_array", "ndarray", "view", "zeros"]

Array: TypeAlias = "ndarray[Any, Any]"
DTYPES: dict[str, np.dtype[np.generic]] = {
    "bool": np.dtype(np.bool_),
    "byte": np.dtype(np.uint8),
    "char": np.dtype(np.uint8),
    **{name: np.dtype(name) for name in INTEGER_RANGES if name not in ("byte", "char")},
    "float32": np.dtype(np.float32),
    "float64": np.dtype(np.float64),
}


def as_array(value: Any, base: str) -> Array:
    """Return `value` as a one-dimensional contiguous array of the ROS type `base`, without a copy if it already is one.

    Raises:
        ValueError: An element has another kind or does not fit.
    """
    dtype = DTYPES[base]
    if isinstance(value, (bytes, bytearray, memoryview)) and dtype.itemsize == 1 and base != "bool":
        return np.frombuffer(value, dtype)
    # numpy gives an empty list the type float64, which the check below would refuse.
    array: Array = np.asarray(value) if len(value) else np.zeros(0, dtype)
    if array.dtype == dtype:
        return np.ascontiguousarray(array).reshape(-1)
    if dtype.kind in "iu" and array.dtype.kind in "fO" and all(type(v) is int for v in value):
        # NumPy found no integer type for these and chose floats or objects, which would lose digits.
        _check_range(min(value), max(value), base)
        return np.array(value, dtype)
    if array.dtype.kind not in {"b": "b", "i": "iu", "u": "iu", "f": "iuf"}[dtype.kind]:
        raise ValueError(f"expected {base} elements, got {array.dtype}")
    if base in INTEGER_RANGES:
        _check_range(int(array.min()), int(array.max()), base)
    with np.errstate(over="ignore"):
        result = np.ascontiguousarray(array.astype(dtype)).reshape(-1)
    if array.dtype.kind == "f":
        too_large = np.isinf(result) & ~np.isinf(array.reshape(-1))
        if too_large.any():
            raise ValueError(f"{array.reshape(-1)[too_large][0]} is too large for {base}")
    return result


def _check_range(smallest: int, largest: int, base: str) -> None:
    low, high = INTEGER_RANGES[base]
    for edge in (smallest, largest):
        if not low <= edge <= high:
            raise ValueError(f"{edge} does not fit {base}: {low} to {high}")


def zeros(base: str, count: int) -> Array:
    """Return a new array of `count` zeros of the ROS type `base`."""
    result: Array = np.zeros(count, DTYPES[base])
    return result


def view(buf: bytes, dtype: np.dtype[np.generic], count: int, offset: int) -> Array:
    """Return a read-only array over `buf`; a copy if the byte order is foreign or the elements are bools."""
    if not count:
        return np.frombuffer(b"", dtype.newbyteorder("="))
    if dtype.kind == "b":
        # Any byte but 0 is true in CDR; numpy's bools must be 0 or 1, and misbehave otherwise.
        result: Array = np.frombuffer(buf, np.uint8, count, offset) != 0
        result.flags.writeable = False
        return result
    array = np.frombuffer(buf, dtype, count, offset)
    if dtype.isnative:
        return array
    array = array.astype(dtype.newbyteorder("="))
    array.flags.writeable = False
    return array
