# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping
from typing import ClassVar, Literal

from graphflow.msgs import base

class State(base.Message):
    PRIMARY_STATE_UNKNOWN: ClassVar[Literal[0]]
    PRIMARY_STATE_UNCONFIGURED: ClassVar[Literal[1]]
    PRIMARY_STATE_INACTIVE: ClassVar[Literal[2]]
    PRIMARY_STATE_ACTIVE: ClassVar[Literal[3]]
    PRIMARY_STATE_FINALIZED: ClassVar[Literal[4]]
    TRANSITION_STATE_CONFIGURING: ClassVar[Literal[10]]
    TRANSITION_STATE_CLEANINGUP: ClassVar[Literal[11]]
    TRANSITION_STATE_SHUTTINGDOWN: ClassVar[Literal[12]]
    TRANSITION_STATE_ACTIVATING: ClassVar[Literal[13]]
    TRANSITION_STATE_DEACTIVATING: ClassVar[Literal[14]]
    TRANSITION_STATE_ERRORPROCESSING: ClassVar[Literal[15]]
    id: int
    label: str
    def __init__(self, *, id: int = ..., label: str = ...) -> None: ...

class Transition(base.Message):
    TRANSITION_CREATE: ClassVar[Literal[0]]
    TRANSITION_CONFIGURE: ClassVar[Literal[1]]
    TRANSITION_CLEANUP: ClassVar[Literal[2]]
    TRANSITION_ACTIVATE: ClassVar[Literal[3]]
    TRANSITION_DEACTIVATE: ClassVar[Literal[4]]
    TRANSITION_UNCONFIGURED_SHUTDOWN: ClassVar[Literal[5]]
    TRANSITION_INACTIVE_SHUTDOWN: ClassVar[Literal[6]]
    TRANSITION_ACTIVE_SHUTDOWN: ClassVar[Literal[7]]
    TRANSITION_DESTROY: ClassVar[Literal[8]]
    TRANSITION_ON_CONFIGURE_SUCCESS: ClassVar[Literal[10]]
    TRANSITION_ON_CONFIGURE_FAILURE: ClassVar[Literal[11]]
    TRANSITION_ON_CONFIGURE_ERROR: ClassVar[Literal[12]]
    TRANSITION_ON_CLEANUP_SUCCESS: ClassVar[Literal[20]]
    TRANSITION_ON_CLEANUP_FAILURE: ClassVar[Literal[21]]
    TRANSITION_ON_CLEANUP_ERROR: ClassVar[Literal[22]]
    TRANSITION_ON_ACTIVATE_SUCCESS: ClassVar[Literal[30]]
    TRANSITION_ON_ACTIVATE_FAILURE: ClassVar[Literal[31]]
    TRANSITION_ON_ACTIVATE_ERROR: ClassVar[Literal[32]]
    TRANSITION_ON_DEACTIVATE_SUCCESS: ClassVar[Literal[40]]
    TRANSITION_ON_DEACTIVATE_FAILURE: ClassVar[Literal[41]]
    TRANSITION_ON_DEACTIVATE_ERROR: ClassVar[Literal[42]]
    TRANSITION_ON_SHUTDOWN_SUCCESS: ClassVar[Literal[50]]
    TRANSITION_ON_SHUTDOWN_FAILURE: ClassVar[Literal[51]]
    TRANSITION_ON_SHUTDOWN_ERROR: ClassVar[Literal[52]]
    TRANSITION_ON_ERROR_SUCCESS: ClassVar[Literal[60]]
    TRANSITION_ON_ERROR_FAILURE: ClassVar[Literal[61]]
    TRANSITION_ON_ERROR_ERROR: ClassVar[Literal[62]]
    TRANSITION_CALLBACK_SUCCESS: ClassVar[Literal[97]]
    TRANSITION_CALLBACK_FAILURE: ClassVar[Literal[98]]
    TRANSITION_CALLBACK_ERROR: ClassVar[Literal[99]]
    id: int
    label: str
    def __init__(self, *, id: int = ..., label: str = ...) -> None: ...

class TransitionDescription(base.Message):
    transition: Transition
    start_state: State
    goal_state: State
    def __init__(
        self,
        *,
        transition: Transition | Mapping[str, object] = ...,
        start_state: State | Mapping[str, object] = ...,
        goal_state: State | Mapping[str, object] = ...,
    ) -> None: ...

class TransitionEvent(base.Message):
    timestamp: int
    transition: Transition
    start_state: State
    goal_state: State
    def __init__(
        self,
        *,
        timestamp: int = ...,
        transition: Transition | Mapping[str, object] = ...,
        start_state: State | Mapping[str, object] = ...,
        goal_state: State | Mapping[str, object] = ...,
    ) -> None: ...
