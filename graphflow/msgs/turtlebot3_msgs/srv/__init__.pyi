# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.service_msgs import msg as service_msgs

class Dqn_Request(base.Message):
    action: int
    init: bool
    def __init__(self, *, action: int = ..., init: bool = ...) -> None: ...

class Dqn_Response(base.Message):
    state: npt.NDArray[np.float32]
    reward: float
    done: bool
    def __init__(
        self,
        *,
        state: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        reward: float = ...,
        done: bool = ...,
    ) -> None: ...

class Dqn_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Dqn_Request]
    response: list[Dqn_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Dqn_Request | Mapping[str, object]] = ...,
        response: Sequence[Dqn_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Dqn(base.Service[Dqn_Request, Dqn_Response]):
    Request: TypeAlias = Dqn_Request
    Response: TypeAlias = Dqn_Response
    Event: TypeAlias = Dqn_Event

class Goal_Request(base.Message):
    def __init__(self) -> None: ...

class Goal_Response(base.Message):
    pose_x: float
    pose_y: float
    success: bool
    def __init__(self, *, pose_x: float = ..., pose_y: float = ..., success: bool = ...) -> None: ...

class Goal_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Goal_Request]
    response: list[Goal_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Goal_Request | Mapping[str, object]] = ...,
        response: Sequence[Goal_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Goal(base.Service[Goal_Request, Goal_Response]):
    Request: TypeAlias = Goal_Request
    Response: TypeAlias = Goal_Response
    Event: TypeAlias = Goal_Event

class Sound_Request(base.Message):
    value: int
    def __init__(self, *, value: int = ...) -> None: ...

class Sound_Response(base.Message):
    success: bool
    message: str
    def __init__(self, *, success: bool = ..., message: str = ...) -> None: ...

class Sound_Event(base.Message):
    info: service_msgs.ServiceEventInfo
    request: list[Sound_Request]
    response: list[Sound_Response]
    def __init__(
        self,
        *,
        info: service_msgs.ServiceEventInfo | Mapping[str, object] = ...,
        request: Sequence[Sound_Request | Mapping[str, object]] = ...,
        response: Sequence[Sound_Response | Mapping[str, object]] = ...,
    ) -> None: ...

class Sound(base.Service[Sound_Request, Sound_Response]):
    Request: TypeAlias = Sound_Request
    Response: TypeAlias = Sound_Response
    Event: TypeAlias = Sound_Event
