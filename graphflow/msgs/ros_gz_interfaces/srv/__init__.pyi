# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.ros_gz_interfaces import msg as ros_gz_interfaces
from graphflow.msgs.service_msgs import msg as service_msgs

class ControlWorld_Request(base.Message):
    world_control: ros_gz_interfaces.WorldControl
    def __init__(self, *, world_control: ros_gz_interfaces.WorldControl | Mapping[str, object] = ...) -> None: ...

class ControlWorld_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class ControlWorld_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ControlWorld_Request]
    response: list[ControlWorld_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ControlWorld_Request | Mapping[str, object]] = ...,
        response: Sequence[ControlWorld_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ControlWorld(base.Service[ControlWorld_Request, ControlWorld_Response]):
    Request: TypeAlias = ControlWorld_Request
    Response: TypeAlias = ControlWorld_Response
    Event: TypeAlias = ControlWorld_Event

class DeleteEntity_Request(base.Message):
    entity: ros_gz_interfaces.Entity
    def __init__(self, *, entity: ros_gz_interfaces.Entity | Mapping[str, object] = ...) -> None: ...

class DeleteEntity_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class DeleteEntity_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[DeleteEntity_Request]
    response: list[DeleteEntity_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[DeleteEntity_Request | Mapping[str, object]] = ...,
        response: Sequence[DeleteEntity_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class DeleteEntity(base.Service[DeleteEntity_Request, DeleteEntity_Response]):
    Request: TypeAlias = DeleteEntity_Request
    Response: TypeAlias = DeleteEntity_Response
    Event: TypeAlias = DeleteEntity_Event

class SetEntityPose_Request(base.Message):
    entity: ros_gz_interfaces.Entity
    pose: geometry_msgs.Pose
    def __init__(
        self,
        *,
        entity: ros_gz_interfaces.Entity | Mapping[str, object] = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
    ) -> None: ...

class SetEntityPose_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class SetEntityPose_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetEntityPose_Request]
    response: list[SetEntityPose_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetEntityPose_Request | Mapping[str, object]] = ...,
        response: Sequence[SetEntityPose_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetEntityPose(base.Service[SetEntityPose_Request, SetEntityPose_Response]):
    Request: TypeAlias = SetEntityPose_Request
    Response: TypeAlias = SetEntityPose_Response
    Event: TypeAlias = SetEntityPose_Event

class SpawnEntity_Request(base.Message):
    entity_factory: ros_gz_interfaces.EntityFactory
    def __init__(self, *, entity_factory: ros_gz_interfaces.EntityFactory | Mapping[str, object] = ...) -> None: ...

class SpawnEntity_Response(base.Message):
    success: bool
    def __init__(self, *, success: bool = ...) -> None: ...

class SpawnEntity_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SpawnEntity_Request]
    response: list[SpawnEntity_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SpawnEntity_Request | Mapping[str, object]] = ...,
        response: Sequence[SpawnEntity_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SpawnEntity(base.Service[SpawnEntity_Request, SpawnEntity_Response]):
    Request: TypeAlias = SpawnEntity_Request
    Response: TypeAlias = SpawnEntity_Response
    Event: TypeAlias = SpawnEntity_Event
