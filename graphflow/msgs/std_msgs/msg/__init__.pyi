# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces

class Bool(base.Message):
    data: bool
    def __init__(self, *, data: bool = ...) -> None: ...

class Byte(base.Message):
    data: int
    def __init__(self, *, data: int | bytes = ...) -> None: ...

class ByteMultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.uint8]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class Char(base.Message):
    data: int
    def __init__(self, *, data: int | bytes = ...) -> None: ...

class ColorRGBA(base.Message):
    r: float
    g: float
    b: float
    a: float
    def __init__(self, *, r: float = ..., g: float = ..., b: float = ..., a: float = ...) -> None: ...

class Empty(base.Message):
    def __init__(self) -> None: ...

class Float32(base.Message):
    data: float
    def __init__(self, *, data: float = ...) -> None: ...

class Float32MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.float32]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class Float64(base.Message):
    data: float
    def __init__(self, *, data: float = ...) -> None: ...

class Float64MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class Header(base.Message):
    stamp: builtin_interfaces.Time
    frame_id: str
    def __init__(
        self,
        *,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        frame_id: str = ...,
    ) -> None: ...

class Int16(base.Message):
    data: int
    def __init__(self, *, data: int = ...) -> None: ...

class Int16MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.int16]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class Int32(base.Message):
    data: int
    def __init__(self, *, data: int = ...) -> None: ...

class Int32MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.int32]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class Int64(base.Message):
    data: int
    def __init__(self, *, data: int = ...) -> None: ...

class Int64MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.int64]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class Int8(base.Message):
    data: int
    def __init__(self, *, data: int = ...) -> None: ...

class Int8MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.int8]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class MultiArrayDimension(base.Message):
    label: str
    size: int
    stride: int
    def __init__(self, *, label: str = ..., size: int = ..., stride: int = ...) -> None: ...

class MultiArrayLayout(base.Message):
    dim: list[MultiArrayDimension]
    data_offset: int
    def __init__(
        self,
        *,
        dim: Sequence[MultiArrayDimension | Mapping[str, object]] = ...,
        data_offset: int = ...,
    ) -> None: ...

class String(base.Message):
    data: str
    def __init__(self, *, data: str = ...) -> None: ...

class UInt16(base.Message):
    data: int
    def __init__(self, *, data: int = ...) -> None: ...

class UInt16MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.uint16]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class UInt32(base.Message):
    data: int
    def __init__(self, *, data: int = ...) -> None: ...

class UInt32MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.uint32]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class UInt64(base.Message):
    data: int
    def __init__(self, *, data: int = ...) -> None: ...

class UInt64MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.uint64]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class UInt8(base.Message):
    data: int
    def __init__(self, *, data: int = ...) -> None: ...

class UInt8MultiArray(base.Message):
    layout: MultiArrayLayout
    data: npt.NDArray[np.uint8]
    def __init__(
        self,
        *,
        layout: MultiArrayLayout | Mapping[str, object] = ...,
        data: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...
