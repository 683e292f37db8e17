# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import Final

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs

class TF2Error(base.Message):
    NO_ERROR: Final = 0
    LOOKUP_ERROR: Final = 1
    CONNECTIVITY_ERROR: Final = 2
    EXTRAPOLATION_ERROR: Final = 3
    INVALID_ARGUMENT_ERROR: Final = 4
    TIMEOUT_ERROR: Final = 5
    TRANSFORM_ERROR: Final = 6
    error: int
    error_string: str
    def __init__(self, *, error: int = ..., error_string: str = ...) -> None: ...

class TFMessage(base.Message):
    transforms: list[geometry_msgs.TransformStamped]
    def __init__(
        self,
        *,
        transforms: Sequence[geometry_msgs.TransformStamped | Mapping[str, object]] = ...,
    ) -> None: ...
