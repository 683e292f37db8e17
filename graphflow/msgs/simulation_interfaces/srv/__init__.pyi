# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal, TypeAlias

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.service_msgs import msg as service_msgs
from graphflow.msgs.simulation_interfaces import msg as simulation_interfaces

class DeleteEntity_Request(base.Message):
    entity: str
    def __init__(self, *, entity: str = ...) -> None: ...

class DeleteEntity_Response(base.Message):
    result: simulation_interfaces.Result
    def __init__(self, *, result: simulation_interfaces.Result | Mapping[str, object] = ...) -> None: ...

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

class GetAvailableWorlds_Request(base.Message):
    additional_sources: list[str]
    filter: simulation_interfaces.TagsFilter
    offline_only: bool
    continue_on_error: bool
    def __init__(
        self,
        *,
        additional_sources: Sequence[str] = ...,
        filter: simulation_interfaces.TagsFilter | Mapping[str, object] = ...,
        offline_only: bool = ...,
        continue_on_error: bool = ...,
    ) -> None: ...

class GetAvailableWorlds_Response(base.Message):
    DEFAULT_SOURCES_FAILED: ClassVar[Literal[101]]
    result: simulation_interfaces.Result
    worlds: list[simulation_interfaces.WorldResource]
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        worlds: Sequence[simulation_interfaces.WorldResource | Mapping[str, object]] = ...,
    ) -> None: ...

class GetAvailableWorlds_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetAvailableWorlds_Request]
    response: list[GetAvailableWorlds_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetAvailableWorlds_Request | Mapping[str, object]] = ...,
        response: Sequence[GetAvailableWorlds_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetAvailableWorlds(base.Service[GetAvailableWorlds_Request, GetAvailableWorlds_Response]):
    Request: TypeAlias = GetAvailableWorlds_Request
    Response: TypeAlias = GetAvailableWorlds_Response
    Event: TypeAlias = GetAvailableWorlds_Event

class GetCurrentWorld_Request(base.Message):
    def __init__(self) -> None: ...

class GetCurrentWorld_Response(base.Message):
    NO_WORLD_LOADED: ClassVar[Literal[101]]
    result: simulation_interfaces.Result
    world: simulation_interfaces.WorldResource
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        world: simulation_interfaces.WorldResource | Mapping[str, object] = ...,
    ) -> None: ...

class GetCurrentWorld_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetCurrentWorld_Request]
    response: list[GetCurrentWorld_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetCurrentWorld_Request | Mapping[str, object]] = ...,
        response: Sequence[GetCurrentWorld_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetCurrentWorld(base.Service[GetCurrentWorld_Request, GetCurrentWorld_Response]):
    Request: TypeAlias = GetCurrentWorld_Request
    Response: TypeAlias = GetCurrentWorld_Response
    Event: TypeAlias = GetCurrentWorld_Event

class GetEntities_Request(base.Message):
    filters: simulation_interfaces.EntityFilters
    def __init__(self, *, filters: simulation_interfaces.EntityFilters | Mapping[str, object] = ...) -> None: ...

class GetEntities_Response(base.Message):
    result: simulation_interfaces.Result
    entities: list[str]
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        entities: Sequence[str] = ...,
    ) -> None: ...

class GetEntities_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetEntities_Request]
    response: list[GetEntities_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetEntities_Request | Mapping[str, object]] = ...,
        response: Sequence[GetEntities_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetEntities(base.Service[GetEntities_Request, GetEntities_Response]):
    Request: TypeAlias = GetEntities_Request
    Response: TypeAlias = GetEntities_Response
    Event: TypeAlias = GetEntities_Event

class GetEntitiesStates_Request(base.Message):
    filters: simulation_interfaces.EntityFilters
    def __init__(self, *, filters: simulation_interfaces.EntityFilters | Mapping[str, object] = ...) -> None: ...

class GetEntitiesStates_Response(base.Message):
    result: simulation_interfaces.Result
    entities: list[str]
    states: list[simulation_interfaces.EntityState]
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        entities: Sequence[str] = ...,
        states: Sequence[simulation_interfaces.EntityState | Mapping[str, object]] = ...,
    ) -> None: ...

class GetEntitiesStates_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetEntitiesStates_Request]
    response: list[GetEntitiesStates_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetEntitiesStates_Request | Mapping[str, object]] = ...,
        response: Sequence[GetEntitiesStates_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetEntitiesStates(base.Service[GetEntitiesStates_Request, GetEntitiesStates_Response]):
    Request: TypeAlias = GetEntitiesStates_Request
    Response: TypeAlias = GetEntitiesStates_Response
    Event: TypeAlias = GetEntitiesStates_Event

class GetEntityBounds_Request(base.Message):
    entity: str
    def __init__(self, *, entity: str = ...) -> None: ...

class GetEntityBounds_Response(base.Message):
    result: simulation_interfaces.Result
    bounds: simulation_interfaces.Bounds
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        bounds: simulation_interfaces.Bounds | Mapping[str, object] = ...,
    ) -> None: ...

class GetEntityBounds_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetEntityBounds_Request]
    response: list[GetEntityBounds_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetEntityBounds_Request | Mapping[str, object]] = ...,
        response: Sequence[GetEntityBounds_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetEntityBounds(base.Service[GetEntityBounds_Request, GetEntityBounds_Response]):
    Request: TypeAlias = GetEntityBounds_Request
    Response: TypeAlias = GetEntityBounds_Response
    Event: TypeAlias = GetEntityBounds_Event

class GetEntityInfo_Request(base.Message):
    entity: str
    def __init__(self, *, entity: str = ...) -> None: ...

class GetEntityInfo_Response(base.Message):
    result: simulation_interfaces.Result
    info: simulation_interfaces.EntityInfo
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        info: simulation_interfaces.EntityInfo | Mapping[str, object] = ...,
    ) -> None: ...

class GetEntityInfo_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetEntityInfo_Request]
    response: list[GetEntityInfo_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetEntityInfo_Request | Mapping[str, object]] = ...,
        response: Sequence[GetEntityInfo_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetEntityInfo(base.Service[GetEntityInfo_Request, GetEntityInfo_Response]):
    Request: TypeAlias = GetEntityInfo_Request
    Response: TypeAlias = GetEntityInfo_Response
    Event: TypeAlias = GetEntityInfo_Event

class GetEntityState_Request(base.Message):
    entity: str
    def __init__(self, *, entity: str = ...) -> None: ...

class GetEntityState_Response(base.Message):
    result: simulation_interfaces.Result
    state: simulation_interfaces.EntityState
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        state: simulation_interfaces.EntityState | Mapping[str, object] = ...,
    ) -> None: ...

class GetEntityState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetEntityState_Request]
    response: list[GetEntityState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetEntityState_Request | Mapping[str, object]] = ...,
        response: Sequence[GetEntityState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetEntityState(base.Service[GetEntityState_Request, GetEntityState_Response]):
    Request: TypeAlias = GetEntityState_Request
    Response: TypeAlias = GetEntityState_Response
    Event: TypeAlias = GetEntityState_Event

class GetNamedPoseBounds_Request(base.Message):
    name: str
    def __init__(self, *, name: str = ...) -> None: ...

class GetNamedPoseBounds_Response(base.Message):
    result: simulation_interfaces.Result
    bounds: simulation_interfaces.Bounds
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        bounds: simulation_interfaces.Bounds | Mapping[str, object] = ...,
    ) -> None: ...

class GetNamedPoseBounds_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetNamedPoseBounds_Request]
    response: list[GetNamedPoseBounds_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetNamedPoseBounds_Request | Mapping[str, object]] = ...,
        response: Sequence[GetNamedPoseBounds_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetNamedPoseBounds(base.Service[GetNamedPoseBounds_Request, GetNamedPoseBounds_Response]):
    Request: TypeAlias = GetNamedPoseBounds_Request
    Response: TypeAlias = GetNamedPoseBounds_Response
    Event: TypeAlias = GetNamedPoseBounds_Event

class GetNamedPoses_Request(base.Message):
    tags: simulation_interfaces.TagsFilter
    def __init__(self, *, tags: simulation_interfaces.TagsFilter | Mapping[str, object] = ...) -> None: ...

class GetNamedPoses_Response(base.Message):
    result: simulation_interfaces.Result
    poses: list[simulation_interfaces.NamedPose]
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        poses: Sequence[simulation_interfaces.NamedPose | Mapping[str, object]] = ...,
    ) -> None: ...

class GetNamedPoses_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetNamedPoses_Request]
    response: list[GetNamedPoses_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetNamedPoses_Request | Mapping[str, object]] = ...,
        response: Sequence[GetNamedPoses_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetNamedPoses(base.Service[GetNamedPoses_Request, GetNamedPoses_Response]):
    Request: TypeAlias = GetNamedPoses_Request
    Response: TypeAlias = GetNamedPoses_Response
    Event: TypeAlias = GetNamedPoses_Event

class GetSimulationState_Request(base.Message):
    def __init__(self) -> None: ...

class GetSimulationState_Response(base.Message):
    state: simulation_interfaces.SimulationState
    result: simulation_interfaces.Result
    def __init__(
        self,
        *,
        state: simulation_interfaces.SimulationState | Mapping[str, object] = ...,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
    ) -> None: ...

class GetSimulationState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetSimulationState_Request]
    response: list[GetSimulationState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetSimulationState_Request | Mapping[str, object]] = ...,
        response: Sequence[GetSimulationState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetSimulationState(base.Service[GetSimulationState_Request, GetSimulationState_Response]):
    Request: TypeAlias = GetSimulationState_Request
    Response: TypeAlias = GetSimulationState_Response
    Event: TypeAlias = GetSimulationState_Event

class GetSimulatorFeatures_Request(base.Message):
    def __init__(self) -> None: ...

class GetSimulatorFeatures_Response(base.Message):
    features: simulation_interfaces.SimulatorFeatures
    def __init__(self, *, features: simulation_interfaces.SimulatorFeatures | Mapping[str, object] = ...) -> None: ...

class GetSimulatorFeatures_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetSimulatorFeatures_Request]
    response: list[GetSimulatorFeatures_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetSimulatorFeatures_Request | Mapping[str, object]] = ...,
        response: Sequence[GetSimulatorFeatures_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetSimulatorFeatures(base.Service[GetSimulatorFeatures_Request, GetSimulatorFeatures_Response]):
    Request: TypeAlias = GetSimulatorFeatures_Request
    Response: TypeAlias = GetSimulatorFeatures_Response
    Event: TypeAlias = GetSimulatorFeatures_Event

class GetSpawnables_Request(base.Message):
    sources: list[str]
    def __init__(self, *, sources: Sequence[str] = ...) -> None: ...

class GetSpawnables_Response(base.Message):
    result: simulation_interfaces.Result
    spawnables: list[simulation_interfaces.Spawnable]
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        spawnables: Sequence[simulation_interfaces.Spawnable | Mapping[str, object]] = ...,
    ) -> None: ...

class GetSpawnables_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[GetSpawnables_Request]
    response: list[GetSpawnables_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[GetSpawnables_Request | Mapping[str, object]] = ...,
        response: Sequence[GetSpawnables_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class GetSpawnables(base.Service[GetSpawnables_Request, GetSpawnables_Response]):
    Request: TypeAlias = GetSpawnables_Request
    Response: TypeAlias = GetSpawnables_Response
    Event: TypeAlias = GetSpawnables_Event

class LoadWorld_Request(base.Message):
    uri: str
    resource_string: str
    fail_on_unsupported_element: bool
    ignore_missing_or_unsupported_assets: bool
    def __init__(
        self,
        *,
        uri: str = ...,
        resource_string: str = ...,
        fail_on_unsupported_element: bool = ...,
        ignore_missing_or_unsupported_assets: bool = ...,
    ) -> None: ...

class LoadWorld_Response(base.Message):
    UNSUPPORTED_FORMAT: ClassVar[Literal[101]]
    NO_RESOURCE: ClassVar[Literal[102]]
    RESOURCE_PARSE_ERROR: ClassVar[Literal[103]]
    MISSING_ASSETS: ClassVar[Literal[104]]
    UNSUPPORTED_ASSETS: ClassVar[Literal[105]]
    UNSUPPORTED_ELEMENTS: ClassVar[Literal[106]]
    result: simulation_interfaces.Result
    world: simulation_interfaces.WorldResource
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        world: simulation_interfaces.WorldResource | Mapping[str, object] = ...,
    ) -> None: ...

class LoadWorld_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[LoadWorld_Request]
    response: list[LoadWorld_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[LoadWorld_Request | Mapping[str, object]] = ...,
        response: Sequence[LoadWorld_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class LoadWorld(base.Service[LoadWorld_Request, LoadWorld_Response]):
    Request: TypeAlias = LoadWorld_Request
    Response: TypeAlias = LoadWorld_Response
    Event: TypeAlias = LoadWorld_Event

class ResetSimulation_Request(base.Message):
    SCOPE_DEFAULT: ClassVar[Literal[0]]
    SCOPE_TIME: ClassVar[Literal[1]]
    SCOPE_STATE: ClassVar[Literal[2]]
    SCOPE_SPAWNED: ClassVar[Literal[4]]
    SCOPE_ALL: ClassVar[Literal[255]]
    scope: int
    def __init__(self, *, scope: int = ...) -> None: ...

class ResetSimulation_Response(base.Message):
    result: simulation_interfaces.Result
    def __init__(self, *, result: simulation_interfaces.Result | Mapping[str, object] = ...) -> None: ...

class ResetSimulation_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[ResetSimulation_Request]
    response: list[ResetSimulation_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[ResetSimulation_Request | Mapping[str, object]] = ...,
        response: Sequence[ResetSimulation_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class ResetSimulation(base.Service[ResetSimulation_Request, ResetSimulation_Response]):
    Request: TypeAlias = ResetSimulation_Request
    Response: TypeAlias = ResetSimulation_Response
    Event: TypeAlias = ResetSimulation_Event

class SetEntityInfo_Request(base.Message):
    entity: str
    info: simulation_interfaces.EntityInfo
    def __init__(
        self,
        *,
        entity: str = ...,
        info: simulation_interfaces.EntityInfo | Mapping[str, object] = ...,
    ) -> None: ...

class SetEntityInfo_Response(base.Message):
    result: simulation_interfaces.Result
    def __init__(self, *, result: simulation_interfaces.Result | Mapping[str, object] = ...) -> None: ...

class SetEntityInfo_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetEntityInfo_Request]
    response: list[SetEntityInfo_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetEntityInfo_Request | Mapping[str, object]] = ...,
        response: Sequence[SetEntityInfo_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetEntityInfo(base.Service[SetEntityInfo_Request, SetEntityInfo_Response]):
    Request: TypeAlias = SetEntityInfo_Request
    Response: TypeAlias = SetEntityInfo_Response
    Event: TypeAlias = SetEntityInfo_Event

class SetEntityState_Request(base.Message):
    entity: str
    state: simulation_interfaces.EntityState
    def __init__(
        self,
        *,
        entity: str = ...,
        state: simulation_interfaces.EntityState | Mapping[str, object] = ...,
    ) -> None: ...

class SetEntityState_Response(base.Message):
    INVALID_POSE: ClassVar[Literal[101]]
    result: simulation_interfaces.Result
    def __init__(self, *, result: simulation_interfaces.Result | Mapping[str, object] = ...) -> None: ...

class SetEntityState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetEntityState_Request]
    response: list[SetEntityState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetEntityState_Request | Mapping[str, object]] = ...,
        response: Sequence[SetEntityState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetEntityState(base.Service[SetEntityState_Request, SetEntityState_Response]):
    Request: TypeAlias = SetEntityState_Request
    Response: TypeAlias = SetEntityState_Response
    Event: TypeAlias = SetEntityState_Event

class SetSimulationState_Request(base.Message):
    state: simulation_interfaces.SimulationState
    def __init__(self, *, state: simulation_interfaces.SimulationState | Mapping[str, object] = ...) -> None: ...

class SetSimulationState_Response(base.Message):
    ALREADY_IN_TARGET_STATE: ClassVar[Literal[101]]
    STATE_TRANSITION_ERROR: ClassVar[Literal[102]]
    INCORRECT_TRANSITION: ClassVar[Literal[103]]
    result: simulation_interfaces.Result
    def __init__(self, *, result: simulation_interfaces.Result | Mapping[str, object] = ...) -> None: ...

class SetSimulationState_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SetSimulationState_Request]
    response: list[SetSimulationState_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SetSimulationState_Request | Mapping[str, object]] = ...,
        response: Sequence[SetSimulationState_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SetSimulationState(base.Service[SetSimulationState_Request, SetSimulationState_Response]):
    Request: TypeAlias = SetSimulationState_Request
    Response: TypeAlias = SetSimulationState_Response
    Event: TypeAlias = SetSimulationState_Event

class SpawnEntities_Request(base.Message):
    spawn_requests: list[simulation_interfaces.SpawnEntity]
    def __init__(
        self,
        *,
        spawn_requests: Sequence[simulation_interfaces.SpawnEntity | Mapping[str, object]] = ...,
    ) -> None: ...

class SpawnEntities_Response(base.Message):
    ENTITIES_SPAWN_FAILED: ClassVar[Literal[150]]
    result: simulation_interfaces.Result
    results: list[simulation_interfaces.SpawnResult]
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        results: Sequence[simulation_interfaces.SpawnResult | Mapping[str, object]] = ...,
    ) -> None: ...

class SpawnEntities_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[SpawnEntities_Request]
    response: list[SpawnEntities_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[SpawnEntities_Request | Mapping[str, object]] = ...,
        response: Sequence[SpawnEntities_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class SpawnEntities(base.Service[SpawnEntities_Request, SpawnEntities_Response]):
    Request: TypeAlias = SpawnEntities_Request
    Response: TypeAlias = SpawnEntities_Response
    Event: TypeAlias = SpawnEntities_Event

class SpawnEntity_Request(base.Message):
    name: str
    allow_renaming: bool
    uri: str
    resource_string: str
    entity_namespace: str
    initial_pose: geometry_msgs.PoseStamped
    def __init__(
        self,
        *,
        name: str = ...,
        allow_renaming: bool = ...,
        uri: str = ...,
        resource_string: str = ...,
        entity_namespace: str = ...,
        initial_pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
    ) -> None: ...

class SpawnEntity_Response(base.Message):
    NAME_NOT_UNIQUE: ClassVar[Literal[101]]
    NAME_INVALID: ClassVar[Literal[102]]
    UNSUPPORTED_FORMAT: ClassVar[Literal[103]]
    NO_RESOURCE: ClassVar[Literal[104]]
    NAMESPACE_INVALID: ClassVar[Literal[105]]
    RESOURCE_PARSE_ERROR: ClassVar[Literal[106]]
    MISSING_ASSETS: ClassVar[Literal[107]]
    UNSUPPORTED_ASSETS: ClassVar[Literal[108]]
    INVALID_POSE: ClassVar[Literal[109]]
    result: simulation_interfaces.Result
    entity_name: str
    def __init__(
        self,
        *,
        result: simulation_interfaces.Result | Mapping[str, object] = ...,
        entity_name: str = ...,
    ) -> None: ...

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

class StepSimulation_Request(base.Message):
    steps: int
    def __init__(self, *, steps: int = ...) -> None: ...

class StepSimulation_Response(base.Message):
    result: simulation_interfaces.Result
    def __init__(self, *, result: simulation_interfaces.Result | Mapping[str, object] = ...) -> None: ...

class StepSimulation_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[StepSimulation_Request]
    response: list[StepSimulation_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[StepSimulation_Request | Mapping[str, object]] = ...,
        response: Sequence[StepSimulation_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class StepSimulation(base.Service[StepSimulation_Request, StepSimulation_Response]):
    Request: TypeAlias = StepSimulation_Request
    Response: TypeAlias = StepSimulation_Response
    Event: TypeAlias = StepSimulation_Event

class UnloadWorld_Request(base.Message):
    def __init__(self) -> None: ...

class UnloadWorld_Response(base.Message):
    NO_WORLD_LOADED: ClassVar[Literal[101]]
    result: simulation_interfaces.Result
    def __init__(self, *, result: simulation_interfaces.Result | Mapping[str, object] = ...) -> None: ...

class UnloadWorld_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[UnloadWorld_Request]
    response: list[UnloadWorld_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[UnloadWorld_Request | Mapping[str, object]] = ...,
        response: Sequence[UnloadWorld_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class UnloadWorld(base.Service[UnloadWorld_Request, UnloadWorld_Response]):
    Request: TypeAlias = UnloadWorld_Request
    Response: TypeAlias = UnloadWorld_Response
    Event: TypeAlias = UnloadWorld_Event
