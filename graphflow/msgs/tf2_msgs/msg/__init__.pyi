# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs

class TF2Error(base.Message):
    NO_ERROR: ClassVar[Literal[0]]
    LOOKUP_ERROR: ClassVar[Literal[1]]
    CONNECTIVITY_ERROR: ClassVar[Literal[2]]
    EXTRAPOLATION_ERROR: ClassVar[Literal[3]]
    INVALID_ARGUMENT_ERROR: ClassVar[Literal[4]]
    TIMEOUT_ERROR: ClassVar[Literal[5]]
    TRANSFORM_ERROR: ClassVar[Literal[6]]
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
