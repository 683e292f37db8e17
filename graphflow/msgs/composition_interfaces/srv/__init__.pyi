# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.rcl_interfaces import msg as rcl_interfaces
from graphflow.msgs.service_msgs import msg as service_msgs

class ListNodes_Request(base.Message):
    def __init__(self) -> None: ...

class ListNodes_Response(base.Message):
    full_node_names: list[str]
    unique_ids: npt.NDArray[np.uint64]
    def __init__(
        self,
        *,
        full_node_names: Sequence[str] = ...,
        unique_ids: Sequence[int] | npt.NDArray[np.integer] = ...,
    ) -> None: ...

class ListNodes_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ListNodes_Request]
    response: list[ListNodes_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ListNodes_Request | Mapping[str, object]] = ...,
        response: Sequence[ListNodes_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ListNodes(base.Service[ListNodes_Request, ListNodes_Response]):
    Request: TypeAlias = ListNodes_Request
    Response: TypeAlias = ListNodes_Response
    Event: TypeAlias = ListNodes_Event

class LoadNode_Request(base.Message):
    package_name: str
    plugin_name: str
    node_name: str
    node_namespace: str
    log_level: int
    remap_rules: list[str]
    parameters: list[rcl_interfaces.Parameter]
    extra_arguments: list[rcl_interfaces.Parameter]
    def __init__(
        self,
        *,
        package_name: str = ...,
        plugin_name: str = ...,
        node_name: str = ...,
        node_namespace: str = ...,
        log_level: int = ...,
        remap_rules: Sequence[str] = ...,
        parameters: Sequence[rcl_interfaces.Parameter | Mapping[str, object]] = ...,
        extra_arguments: Sequence[rcl_interfaces.Parameter | Mapping[str, object]] = ...,
    ) -> None: ...

class LoadNode_Response(base.Message):
    success: bool
    error_message: str
    full_node_name: str
    unique_id: int
    def __init__(
        self,
        *,
        success: bool = ...,
        error_message: str = ...,
        full_node_name: str = ...,
        unique_id: int = ...,
    ) -> None: ...

class LoadNode_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[LoadNode_Request]
    response: list[LoadNode_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[LoadNode_Request | Mapping[str, object]] = ...,
        response: Sequence[LoadNode_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class LoadNode(base.Service[LoadNode_Request, LoadNode_Response]):
    Request: TypeAlias = LoadNode_Request
    Response: TypeAlias = LoadNode_Response
    Event: TypeAlias = LoadNode_Event

class UnloadNode_Request(base.Message):
    unique_id: int
    def __init__(self, *, unique_id: int = ...) -> None: ...

class UnloadNode_Response(base.Message):
    success: bool
    error_message: str
    def __init__(self, *, success: bool = ..., error_message: str = ...) -> None: ...

class UnloadNode_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[UnloadNode_Request]
    response: list[UnloadNode_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[UnloadNode_Request | Mapping[str, object]] = ...,
        response: Sequence[UnloadNode_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class UnloadNode(base.Service[UnloadNode_Request, UnloadNode_Response]):
    Request: TypeAlias = UnloadNode_Request
    Response: TypeAlias = UnloadNode_Response
    Event: TypeAlias = UnloadNode_Event
