# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.rcl_interfaces import msg as rcl_interfaces

class Action(base.Message):
    name: str
    send_goal: Service
    get_result: Service
    cancel_goal: Service
    feedback: Topic
    status: Topic
    def __init__(
        self,
        *,
        name: str = ...,
        send_goal: Service | Mapping[str, object] = ...,
        get_result: Service | Mapping[str, object] = ...,
        cancel_goal: Service | Mapping[str, object] = ...,
        feedback: Topic | Mapping[str, object] = ...,
        status: Topic | Mapping[str, object] = ...,
    ) -> None: ...

class Clock(base.Message):
    clock: builtin_interfaces.Time
    def __init__(self, *, clock: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...) -> None: ...

class Graph(base.Message):
    nodes: list[Node]
    def __init__(self, *, nodes: Sequence[Node | Mapping[str, object]] = ...) -> None: ...

class InterfaceType(base.Message):
    name: str
    hash: TypeHash
    def __init__(self, *, name: str = ..., hash: TypeHash | Mapping[str, object] = ...) -> None: ...

class Node(base.Message):
    name: str
    parameters: list[rcl_interfaces.ParameterDescriptor]
    parameter_values: list[rcl_interfaces.ParameterValue]
    publishers: list[Topic]
    subscriptions: list[Topic]
    service_clients: list[Service]
    service_servers: list[Service]
    action_clients: list[Action]
    action_servers: list[Action]
    def __init__(
        self,
        *,
        name: str = ...,
        parameters: Sequence[rcl_interfaces.ParameterDescriptor | Mapping[str, object]] = ...,
        parameter_values: Sequence[rcl_interfaces.ParameterValue | Mapping[str, object]] = ...,
        publishers: Sequence[Topic | Mapping[str, object]] = ...,
        subscriptions: Sequence[Topic | Mapping[str, object]] = ...,
        service_clients: Sequence[Service | Mapping[str, object]] = ...,
        service_servers: Sequence[Service | Mapping[str, object]] = ...,
        action_clients: Sequence[Action | Mapping[str, object]] = ...,
        action_servers: Sequence[Action | Mapping[str, object]] = ...,
    ) -> None: ...

class QoSProfile(base.Message):
    HISTORY_SYSTEM_DEFAULT: ClassVar[Literal[0]]
    HISTORY_KEEP_LAST: ClassVar[Literal[1]]
    HISTORY_KEEP_ALL: ClassVar[Literal[2]]
    HISTORY_UNKNOWN: ClassVar[Literal[3]]
    RELIABILITY_SYSTEM_DEFAULT: ClassVar[Literal[0]]
    RELIABILITY_RELIABLE: ClassVar[Literal[1]]
    RELIABILITY_BEST_EFFORT: ClassVar[Literal[2]]
    RELIABILITY_UNKNOWN: ClassVar[Literal[3]]
    RELIABILITY_BEST_AVAILABLE: ClassVar[Literal[4]]
    DURABILITY_SYSTEM_DEFAULT: ClassVar[Literal[0]]
    DURABILITY_TRANSIENT_LOCAL: ClassVar[Literal[1]]
    DURABILITY_VOLATILE: ClassVar[Literal[2]]
    DURABILITY_UNKNOWN: ClassVar[Literal[3]]
    DURABILITY_BEST_AVAILABLE: ClassVar[Literal[4]]
    LIVELINESS_SYSTEM_DEFAULT: ClassVar[Literal[0]]
    LIVELINESS_AUTOMATIC: ClassVar[Literal[1]]
    LIVELINESS_MANUAL_BY_TOPIC: ClassVar[Literal[3]]
    LIVELINESS_UNKNOWN: ClassVar[Literal[4]]
    LIVELINESS_BEST_AVAILABLE: ClassVar[Literal[5]]
    depth: int
    deadline: builtin_interfaces.Duration
    lifespan: builtin_interfaces.Duration
    history: int
    reliability: int
    durability: int
    liveliness: int
    liveliness_lease_duration: builtin_interfaces.Duration
    def __init__(
        self,
        *,
        depth: int = ...,
        deadline: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        lifespan: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        history: int = ...,
        reliability: int = ...,
        durability: int = ...,
        liveliness: int = ...,
        liveliness_lease_duration: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
    ) -> None: ...

class Service(base.Message):
    name: str
    request_type: InterfaceType
    request_qos: QoSProfile
    response_type: InterfaceType
    response_qos: QoSProfile
    def __init__(
        self,
        *,
        name: str = ...,
        request_type: InterfaceType | Mapping[str, object] = ...,
        request_qos: QoSProfile | Mapping[str, object] = ...,
        response_type: InterfaceType | Mapping[str, object] = ...,
        response_qos: QoSProfile | Mapping[str, object] = ...,
    ) -> None: ...

class Topic(base.Message):
    name: str
    type: InterfaceType
    qos: QoSProfile
    def __init__(
        self,
        *,
        name: str = ...,
        type: InterfaceType | Mapping[str, object] = ...,
        qos: QoSProfile | Mapping[str, object] = ...,
    ) -> None: ...

class TypeHash(base.Message):
    version: int
    value: npt.NDArray[np.uint8]
    def __init__(self, *, version: int = ..., value: Sequence[int] | npt.NDArray[np.integer] = ...) -> None: ...
