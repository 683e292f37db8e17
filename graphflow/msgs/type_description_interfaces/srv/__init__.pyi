# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.type_description_interfaces import msg as type_description_interfaces

class GetTypeDescription_Request(base.Message):
    type_name: str
    type_hash: str
    include_type_sources: bool
    def __init__(self, *, type_name: str = ..., type_hash: str = ..., include_type_sources: bool = ...) -> None: ...

class GetTypeDescription_Response(base.Message):
    successful: bool
    failure_reason: str
    type_description: type_description_interfaces.TypeDescription
    type_sources: list[type_description_interfaces.TypeSource]
    extra_information: list[type_description_interfaces.KeyValue]
    def __init__(
        self,
        *,
        successful: bool = ...,
        failure_reason: str = ...,
        type_description: type_description_interfaces.TypeDescription | Mapping[str, object] = ...,
        type_sources: Sequence[type_description_interfaces.TypeSource | Mapping[str, object]] = ...,
        extra_information: Sequence[type_description_interfaces.KeyValue | Mapping[str, object]] = ...,
    ) -> None: ...

class GetTypeDescription_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetTypeDescription_Request]
    response: list[GetTypeDescription_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetTypeDescription_Request | Mapping[str, object]] = ...,
        response: Sequence[GetTypeDescription_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetTypeDescription(base.Service[GetTypeDescription_Request, GetTypeDescription_Response]):
    Request: TypeAlias = GetTypeDescription_Request
    Response: TypeAlias = GetTypeDescription_Response
    Event: TypeAlias = GetTypeDescription_Event
