# Written by `python -m graphflow.msgs.stubs`; do not edit.

from graphflow import times
from graphflow.msgs import base

class Duration(times.DurationFields, base.Message):
    sec: int
    nanosec: int
    def __init__(self, *, sec: int = ..., nanosec: int = ...) -> None: ...

class Time(times.TimeFields, base.Message):
    sec: int
    nanosec: int
    def __init__(self, *, sec: int = ..., nanosec: int = ...) -> None: ...
