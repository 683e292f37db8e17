# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.rcl_interfaces import msg as rcl_interfaces
from graphflow.msgs.service_msgs import msg as service_msgs

class DescribeParameters_Request(base.Message):
    names: list[str]
    def __init__(self, *, names: Sequence[str] = ...) -> None: ...

class DescribeParameters_Response(base.Message):
    descriptors: list[rcl_interfaces.ParameterDescriptor]
    def __init__(
        self,
        *,
        descriptors: Sequence[rcl_interfaces.ParameterDescriptor | Mapping[str, object]] = ...,
    ) -> None: ...

class DescribeParameters_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DescribeParameters_Request]
    response: list[DescribeParameters_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DescribeParameters_Request | Mapping[str, object]] = ...,
        response: Sequence[DescribeParameters_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DescribeParameters(base.Service[DescribeParameters_Request, DescribeParameters_Response]):
    Request: TypeAlias = DescribeParameters_Request
    Response: TypeAlias = DescribeParameters_Response
    Event: TypeAlias = DescribeParameters_Event

class GetLoggerLevels_Request(base.Message):
    names: list[str]
    def __init__(self, *, names: Sequence[str] = ...) -> None: ...

class GetLoggerLevels_Response(base.Message):
    levels: list[rcl_interfaces.LoggerLevel]
    def __init__(self, *, levels: Sequence[rcl_interfaces.LoggerLevel | Mapping[str, object]] = ...) -> None: ...

class GetLoggerLevels_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetLoggerLevels_Request]
    response: list[GetLoggerLevels_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetLoggerLevels_Request | Mapping[str, object]] = ...,
        response: Sequence[GetLoggerLevels_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetLoggerLevels(base.Service[GetLoggerLevels_Request, GetLoggerLevels_Response]):
    Request: TypeAlias = GetLoggerLevels_Request
    Response: TypeAlias = GetLoggerLevels_Response
    Event: TypeAlias = GetLoggerLevels_Event

class GetParameterTypes_Request(base.Message):
    names: list[str]
    def __init__(self, *, names: Sequence[str] = ...) -> None: ...

class GetParameterTypes_Response(base.Message):
    types: npt.NDArray[np.uint8]
    def __init__(self, *, types: Sequence[int] | npt.NDArray[np.integer] = ...) -> None: ...

class GetParameterTypes_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetParameterTypes_Request]
    response: list[GetParameterTypes_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetParameterTypes_Request | Mapping[str, object]] = ...,
        response: Sequence[GetParameterTypes_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetParameterTypes(base.Service[GetParameterTypes_Request, GetParameterTypes_Response]):
    Request: TypeAlias = GetParameterTypes_Request
    Response: TypeAlias = GetParameterTypes_Response
    Event: TypeAlias = GetParameterTypes_Event

class GetParameters_Request(base.Message):
    names: list[str]
    def __init__(self, *, names: Sequence[str] = ...) -> None: ...

class GetParameters_Response(base.Message):
    values: list[rcl_interfaces.ParameterValue]
    def __init__(self, *, values: Sequence[rcl_interfaces.ParameterValue | Mapping[str, object]] = ...) -> None: ...

class GetParameters_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetParameters_Request]
    response: list[GetParameters_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetParameters_Request | Mapping[str, object]] = ...,
        response: Sequence[GetParameters_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetParameters(base.Service[GetParameters_Request, GetParameters_Response]):
    Request: TypeAlias = GetParameters_Request
    Response: TypeAlias = GetParameters_Response
    Event: TypeAlias = GetParameters_Event

class ListParameters_Request(base.Message):
    DEPTH_RECURSIVE: ClassVar[Literal[0]]
    prefixes: list[str]
    depth: int
    def __init__(self, *, prefixes: Sequence[str] = ..., depth: int = ...) -> None: ...

class ListParameters_Response(base.Message):
    result: rcl_interfaces.ListParametersResult
    def __init__(self, *, result: rcl_interfaces.ListParametersResult | Mapping[str, object] = ...) -> None: ...

class ListParameters_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ListParameters_Request]
    response: list[ListParameters_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ListParameters_Request | Mapping[str, object]] = ...,
        response: Sequence[ListParameters_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ListParameters(base.Service[ListParameters_Request, ListParameters_Response]):
    Request: TypeAlias = ListParameters_Request
    Response: TypeAlias = ListParameters_Response
    Event: TypeAlias = ListParameters_Event

class SetLoggerLevels_Request(base.Message):
    levels: list[rcl_interfaces.LoggerLevel]
    def __init__(self, *, levels: Sequence[rcl_interfaces.LoggerLevel | Mapping[str, object]] = ...) -> None: ...

class SetLoggerLevels_Response(base.Message):
    results: list[rcl_interfaces.SetLoggerLevelsResult]
    def __init__(
        self,
        *,
        results: Sequence[rcl_interfaces.SetLoggerLevelsResult | Mapping[str, object]] = ...,
    ) -> None: ...

class SetLoggerLevels_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetLoggerLevels_Request]
    response: list[SetLoggerLevels_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetLoggerLevels_Request | Mapping[str, object]] = ...,
        response: Sequence[SetLoggerLevels_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetLoggerLevels(base.Service[SetLoggerLevels_Request, SetLoggerLevels_Response]):
    Request: TypeAlias = SetLoggerLevels_Request
    Response: TypeAlias = SetLoggerLevels_Response
    Event: TypeAlias = SetLoggerLevels_Event

class SetParameters_Request(base.Message):
    parameters: list[rcl_interfaces.Parameter]
    def __init__(self, *, parameters: Sequence[rcl_interfaces.Parameter | Mapping[str, object]] = ...) -> None: ...

class SetParameters_Response(base.Message):
    results: list[rcl_interfaces.SetParametersResult]
    def __init__(
        self,
        *,
        results: Sequence[rcl_interfaces.SetParametersResult | Mapping[str, object]] = ...,
    ) -> None: ...

class SetParameters_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetParameters_Request]
    response: list[SetParameters_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetParameters_Request | Mapping[str, object]] = ...,
        response: Sequence[SetParameters_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetParameters(base.Service[SetParameters_Request, SetParameters_Response]):
    Request: TypeAlias = SetParameters_Request
    Response: TypeAlias = SetParameters_Response
    Event: TypeAlias = SetParameters_Event

class SetParametersAtomically_Request(base.Message):
    parameters: list[rcl_interfaces.Parameter]
    def __init__(self, *, parameters: Sequence[rcl_interfaces.Parameter | Mapping[str, object]] = ...) -> None: ...

class SetParametersAtomically_Response(base.Message):
    result: rcl_interfaces.SetParametersResult
    def __init__(self, *, result: rcl_interfaces.SetParametersResult | Mapping[str, object] = ...) -> None: ...

class SetParametersAtomically_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetParametersAtomically_Request]
    response: list[SetParametersAtomically_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetParametersAtomically_Request | Mapping[str, object]] = ...,
        response: Sequence[SetParametersAtomically_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetParametersAtomically(base.Service[SetParametersAtomically_Request, SetParametersAtomically_Response]):
    Request: TypeAlias = SetParametersAtomically_Request
    Response: TypeAlias = SetParametersAtomically_Response
    Event: TypeAlias = SetParametersAtomically_Event
