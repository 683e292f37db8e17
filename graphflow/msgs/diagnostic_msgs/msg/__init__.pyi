# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

from graphflow.msgs import base
from graphflow.msgs.std_msgs import msg as std_msgs

class DiagnosticArray(base.Message):
    header: std_msgs.Header
    status: list[DiagnosticStatus]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        status: Sequence[DiagnosticStatus | Mapping[str, object]] = ...,
    ) -> None: ...

class DiagnosticStatus(base.Message):
    OK: ClassVar[Literal[0]]
    WARN: ClassVar[Literal[1]]
    ERROR: ClassVar[Literal[2]]
    STALE: ClassVar[Literal[3]]
    level: int
    name: str
    message: str
    hardware_id: str
    values: list[KeyValue]
    def __init__(
        self,
        *,
        level: int | bytes = ...,
        name: str = ...,
        message: str = ...,
        hardware_id: str = ...,
        values: Sequence[KeyValue | Mapping[str, object]] = ...,
    ) -> None: ...

class KeyValue(base.Message):
    key: str
    value: str
    def __init__(self, *, key: str = ..., value: str = ...) -> None: ...
