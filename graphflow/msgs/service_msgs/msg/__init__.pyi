# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces

class ServiceEventInfo(base.Message):
    REQUEST_SENT: ClassVar[Literal[0]]
    REQUEST_RECEIVED: ClassVar[Literal[1]]
    RESPONSE_SENT: ClassVar[Literal[2]]
    RESPONSE_RECEIVED: ClassVar[Literal[3]]
    event_type: int
    stamp: builtin_interfaces.Time
    client_gid: npt.NDArray[np.uint8]
    sequence_number: int
    def __init__(
        self,
        *,
        event_type: int = ...,
        stamp: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        client_gid: Sequence[int] | npt.NDArray[np.integer] = ...,
        sequence_number: int = ...,
    ) -> None: ...
