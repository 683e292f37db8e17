# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces

class MetricsMessage(base.Message):
    measurement_source_name: str
    metrics_source: str
    unit: str
    window_start: builtin_interfaces.Time
    window_stop: builtin_interfaces.Time
    statistics: list[StatisticDataPoint]
    def __init__(
        self,
        *,
        measurement_source_name: str = ...,
        metrics_source: str = ...,
        unit: str = ...,
        window_start: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        window_stop: builtin_interfaces.Time | Mapping[str, object] | times.Time = ...,
        statistics: Sequence[StatisticDataPoint | Mapping[str, object]] = ...,
    ) -> None: ...

class StatisticDataPoint(base.Message):
    data_type: int
    data: float
    def __init__(self, *, data_type: int = ..., data: float = ...) -> None: ...

class StatisticDataType(base.Message):
    STATISTICS_DATA_TYPE_UNINITIALIZED: ClassVar[Literal[0]]
    STATISTICS_DATA_TYPE_AVERAGE: ClassVar[Literal[1]]
    STATISTICS_DATA_TYPE_MINIMUM: ClassVar[Literal[2]]
    STATISTICS_DATA_TYPE_MAXIMUM: ClassVar[Literal[3]]
    STATISTICS_DATA_TYPE_STDDEV: ClassVar[Literal[4]]
    STATISTICS_DATA_TYPE_SAMPLE_COUNT: ClassVar[Literal[5]]
    def __init__(self) -> None: ...
