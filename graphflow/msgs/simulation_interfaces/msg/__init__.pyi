# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class Bounds(base.Message):
    TYPE_EMPTY: ClassVar[Literal[0]]
    TYPE_BOX: ClassVar[Literal[1]]
    TYPE_CONVEX_HULL: ClassVar[Literal[2]]
    TYPE_SPHERE: ClassVar[Literal[3]]
    type: int
    points: list[geometry_msgs.Vector3]
    def __init__(
        self,
        *,
        type: int = ...,
        points: Sequence[geometry_msgs.Vector3 | Mapping[str, object]] = ...,
    ) -> None: ...

class EntityCategory(base.Message):
    CATEGORY_OBJECT: ClassVar[Literal[0]]
    CATEGORY_ROBOT: ClassVar[Literal[1]]
    CATEGORY_HUMAN: ClassVar[Literal[2]]
    CATEGORY_DYNAMIC_OBJECT: ClassVar[Literal[4]]
    CATEGORY_STATIC_OBJECT: ClassVar[Literal[5]]
    category: int
    def __init__(self, *, category: int = ...) -> None: ...

class EntityFilters(base.Message):
    filter: str
    categories: list[EntityCategory]
    tags: TagsFilter
    bounds: Bounds
    def __init__(
        self,
        *,
        filter: str = ...,
        categories: Sequence[EntityCategory | Mapping[str, object]] = ...,
        tags: TagsFilter | Mapping[str, object] = ...,
        bounds: Bounds | Mapping[str, object] = ...,
    ) -> None: ...

class EntityInfo(base.Message):
    category: EntityCategory
    description: str
    tags: list[str]
    def __init__(
        self,
        *,
        category: EntityCategory | Mapping[str, object] = ...,
        description: str = ...,
        tags: Sequence[str] = ...,
    ) -> None: ...

class EntityState(base.Message):
    header: std_msgs.Header
    pose: geometry_msgs.Pose
    twist: geometry_msgs.Twist
    acceleration: geometry_msgs.Accel
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        twist: geometry_msgs.Twist | Mapping[str, object] = ...,
        acceleration: geometry_msgs.Accel | Mapping[str, object] = ...,
    ) -> None: ...

class NamedPose(base.Message):
    name: str
    description: str
    tags: list[str]
    pose: geometry_msgs.Pose
    def __init__(
        self,
        *,
        name: str = ...,
        description: str = ...,
        tags: Sequence[str] = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
    ) -> None: ...

class Resource(base.Message):
    uri: str
    resource_string: str
    def __init__(self, *, uri: str = ..., resource_string: str = ...) -> None: ...

class Result(base.Message):
    RESULT_FEATURE_UNSUPPORTED: ClassVar[Literal[0]]
    RESULT_OK: ClassVar[Literal[1]]
    RESULT_NOT_FOUND: ClassVar[Literal[2]]
    RESULT_INCORRECT_STATE: ClassVar[Literal[3]]
    RESULT_OPERATION_FAILED: ClassVar[Literal[4]]
    result: int
    error_message: str
    def __init__(self, *, result: int = ..., error_message: str = ...) -> None: ...

class SimulationState(base.Message):
    STATE_STOPPED: ClassVar[Literal[0]]
    STATE_PLAYING: ClassVar[Literal[1]]
    STATE_PAUSED: ClassVar[Literal[2]]
    STATE_QUITTING: ClassVar[Literal[3]]
    STATE_NO_WORLD: ClassVar[Literal[4]]
    STATE_LOADING_WORLD: ClassVar[Literal[5]]
    state: int
    def __init__(self, *, state: int = ...) -> None: ...

class SimulatorFeatures(base.Message):
    SPAWNING: ClassVar[Literal[0]]
    DELETING: ClassVar[Literal[1]]
    NAMED_POSES: ClassVar[Literal[2]]
    POSE_BOUNDS: ClassVar[Literal[3]]
    ENTITY_TAGS: ClassVar[Literal[4]]
    ENTITY_BOUNDS: ClassVar[Literal[5]]
    ENTITY_BOUNDS_BOX: ClassVar[Literal[6]]
    ENTITY_BOUNDS_CONVEX: ClassVar[Literal[7]]
    ENTITY_CATEGORIES: ClassVar[Literal[8]]
    SPAWNING_RESOURCE_STRING: ClassVar[Literal[9]]
    ENTITY_STATE_GETTING: ClassVar[Literal[10]]
    ENTITY_STATE_SETTING: ClassVar[Literal[11]]
    ENTITY_INFO_GETTING: ClassVar[Literal[12]]
    ENTITY_INFO_SETTING: ClassVar[Literal[13]]
    SPAWNABLES: ClassVar[Literal[14]]
    SIMULATION_RESET: ClassVar[Literal[20]]
    SIMULATION_RESET_TIME: ClassVar[Literal[21]]
    SIMULATION_RESET_STATE: ClassVar[Literal[22]]
    SIMULATION_RESET_SPAWNED: ClassVar[Literal[23]]
    SIMULATION_STATE_GETTING: ClassVar[Literal[24]]
    SIMULATION_STATE_SETTING: ClassVar[Literal[25]]
    SIMULATION_STATE_PAUSE: ClassVar[Literal[26]]
    STEP_SIMULATION_SINGLE: ClassVar[Literal[31]]
    STEP_SIMULATION_MULTIPLE: ClassVar[Literal[32]]
    STEP_SIMULATION_ACTION: ClassVar[Literal[33]]
    WORLD_LOADING: ClassVar[Literal[40]]
    WORLD_RESOURCE_STRING: ClassVar[Literal[41]]
    WORLD_TAGS: ClassVar[Literal[42]]
    WORLD_UNLOADING: ClassVar[Literal[43]]
    WORLD_INFO_GETTING: ClassVar[Literal[44]]
    AVAILABLE_WORLDS: ClassVar[Literal[45]]
    SPAWNING_ENTITIES: ClassVar[Literal[50]]
    features: npt.NDArray[np.uint16]
    spawn_formats: list[str]
    custom_info: str
    def __init__(
        self,
        *,
        features: Sequence[int] | npt.NDArray[np.integer] = ...,
        spawn_formats: Sequence[str] = ...,
        custom_info: str = ...,
    ) -> None: ...

class SpawnEntity(base.Message):
    name: str
    allow_renaming: bool
    entity_resource: Resource
    entity_namespace: str
    initial_pose: geometry_msgs.PoseStamped
    def __init__(
        self,
        *,
        name: str = ...,
        allow_renaming: bool = ...,
        entity_resource: Resource | Mapping[str, object] = ...,
        entity_namespace: str = ...,
        initial_pose: geometry_msgs.PoseStamped | Mapping[str, object] = ...,
    ) -> None: ...

class SpawnResult(base.Message):
    NAME_NOT_UNIQUE: ClassVar[Literal[101]]
    NAME_INVALID: ClassVar[Literal[102]]
    UNSUPPORTED_FORMAT: ClassVar[Literal[103]]
    NO_RESOURCE: ClassVar[Literal[104]]
    NAMESPACE_INVALID: ClassVar[Literal[105]]
    RESOURCE_PARSE_ERROR: ClassVar[Literal[106]]
    MISSING_ASSETS: ClassVar[Literal[107]]
    UNSUPPORTED_ASSETS: ClassVar[Literal[108]]
    INVALID_POSE: ClassVar[Literal[109]]
    result: Result
    entity_name: str
    def __init__(self, *, result: Result | Mapping[str, object] = ..., entity_name: str = ...) -> None: ...

class Spawnable(base.Message):
    uri: str
    description: str
    spawn_bounds: Bounds
    def __init__(
        self,
        *,
        uri: str = ...,
        description: str = ...,
        spawn_bounds: Bounds | Mapping[str, object] = ...,
    ) -> None: ...

class TagsFilter(base.Message):
    FILTER_MODE_ANY: ClassVar[Literal[0]]
    FILTER_MODE_ALL: ClassVar[Literal[1]]
    tags: list[str]
    filter_mode: int
    def __init__(self, *, tags: Sequence[str] = ..., filter_mode: int = ...) -> None: ...

class WorldResource(base.Message):
    name: str
    world_resource: Resource
    description: str
    tags: list[str]
    def __init__(
        self,
        *,
        name: str = ...,
        world_resource: Resource | Mapping[str, object] = ...,
        description: str = ...,
        tags: Sequence[str] = ...,
    ) -> None: ...
