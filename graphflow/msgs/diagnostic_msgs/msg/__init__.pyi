# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import Final

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
    OK: Final = 0
    WARN: Final = 1
    ERROR: Final = 2
    STALE: Final = 3
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
