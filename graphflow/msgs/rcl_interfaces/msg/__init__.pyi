# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces

class FloatingPointRange(base.Message):
    from_value: float
    to_value: float
    step: float
    def __init__(self, *, from_value: float = ..., to_value: float = ..., step: float = ...) -> None: ...

class IntegerRange(base.Message):
    from_value: int
    to_value: int
    step: int
    def __init__(self, *, from_value: int = ..., to_value: int = ..., step: int = ...) -> None: ...

class ListParametersResult(base.Message):
    names: list[str]
    prefixes: list[str]
    def __init__(self, *, names: Sequence[str] = ..., prefixes: Sequence[str] = ...) -> None: ...

class Log(base.Message):
    DEBUG: ClassVar[Literal[10]]
    INFO: ClassVar[Literal[20]]
    WARN: ClassVar[Literal[30]]
    ERROR: ClassVar[Literal[40]]
    FATAL: ClassVar[Literal[50]]
    stamp: builtin_interfaces.Time
    level: int
    name: str
    msg: str
    file: str
    function: str
    line: int
    def __init__(
        self,
        *,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        level: int = ...,
        name: str = ...,
        msg: str = ...,
        file: str = ...,
        function: str = ...,
        line: int = ...,
    ) -> None: ...

class LoggerLevel(base.Message):
    LOG_LEVEL_UNKNOWN: ClassVar[Literal[0]]
    LOG_LEVEL_DEBUG: ClassVar[Literal[10]]
    LOG_LEVEL_INFO: ClassVar[Literal[20]]
    LOG_LEVEL_WARN: ClassVar[Literal[30]]
    LOG_LEVEL_ERROR: ClassVar[Literal[40]]
    LOG_LEVEL_FATAL: ClassVar[Literal[50]]
    name: str
    level: int
    def __init__(self, *, name: str = ..., level: int = ...) -> None: ...

class Parameter(base.Message):
    name: str
    value: ParameterValue
    def __init__(self, *, name: str = ..., value: ParameterValue | Mapping[str, object] = ...) -> None: ...

class ParameterDescriptor(base.Message):
    name: str
    type: int
    description: str
    additional_constraints: str
    read_only: bool
    dynamic_typing: bool
    floating_point_range: list[FloatingPointRange]
    integer_range: list[IntegerRange]
    def __init__(
        self,
        *,
        name: str = ...,
        type: int = ...,
        description: str = ...,
        additional_constraints: str = ...,
        read_only: bool = ...,
        dynamic_typing: bool = ...,
        floating_point_range: Sequence[FloatingPointRange | Mapping[str, object]] = ...,
        integer_range: Sequence[IntegerRange | Mapping[str, object]] = ...,
    ) -> None: ...

class ParameterEvent(base.Message):
    stamp: builtin_interfaces.Time
    node: str
    new_parameters: list[Parameter]
    changed_parameters: list[Parameter]
    deleted_parameters: list[Parameter]
    def __init__(
        self,
        *,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        node: str = ...,
        new_parameters: Sequence[Parameter | Mapping[str, object]] = ...,
        changed_parameters: Sequence[Parameter | Mapping[str, object]] = ...,
        deleted_parameters: Sequence[Parameter | Mapping[str, object]] = ...,
    ) -> None: ...

class ParameterEventDescriptors(base.Message):
    new_parameters: list[ParameterDescriptor]
    changed_parameters: list[ParameterDescriptor]
    deleted_parameters: list[ParameterDescriptor]
    def __init__(
        self,
        *,
        new_parameters: Sequence[ParameterDescriptor | Mapping[str, object]] = ...,
        changed_parameters: Sequence[ParameterDescriptor | Mapping[str, object]] = ...,
        deleted_parameters: Sequence[ParameterDescriptor | Mapping[str, object]] = ...,
    ) -> None: ...

class ParameterType(base.Message):
    PARAMETER_NOT_SET: ClassVar[Literal[0]]
    PARAMETER_BOOL: ClassVar[Literal[1]]
    PARAMETER_INTEGER: ClassVar[Literal[2]]
    PARAMETER_DOUBLE: ClassVar[Literal[3]]
    PARAMETER_STRING: ClassVar[Literal[4]]
    PARAMETER_BYTE_ARRAY: ClassVar[Literal[5]]
    PARAMETER_BOOL_ARRAY: ClassVar[Literal[6]]
    PARAMETER_INTEGER_ARRAY: ClassVar[Literal[7]]
    PARAMETER_DOUBLE_ARRAY: ClassVar[Literal[8]]
    PARAMETER_STRING_ARRAY: ClassVar[Literal[9]]
    def __init__(self) -> None: ...

class ParameterValue(base.Message):
    type: int
    bool_value: bool
    integer_value: int
    double_value: float
    string_value: str
    byte_array_value: npt.NDArray[np.uint8]
    bool_array_value: npt.NDArray[np.bool_]
    integer_array_value: npt.NDArray[np.int64]
    double_array_value: npt.NDArray[np.float64]
    string_array_value: list[str]
    def __init__(
        self,
        *,
        type: int = ...,
        bool_value: bool = ...,
        integer_value: int = ...,
        double_value: float = ...,
        string_value: str = ...,
        byte_array_value: Sequence[int] | npt.NDArray[np.integer] = ...,
        bool_array_value: Sequence[bool] | npt.NDArray[np.bool_] = ...,
        integer_array_value: Sequence[int] | npt.NDArray[np.integer] = ...,
        double_array_value: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        string_array_value: Sequence[str] = ...,
    ) -> None: ...

class SetLoggerLevelsResult(base.Message):
    successful: bool
    reason: str
    def __init__(self, *, successful: bool = ..., reason: str = ...) -> None: ...

class SetParametersResult(base.Message):
    successful: bool
    reason: str
    def __init__(self, *, successful: bool = ..., reason: str = ...) -> None: ...
