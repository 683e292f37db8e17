# Written by `python -m graphflow.msgs.stubs`; do not edit.

from graphflow.msgs import base

class Duration(base.Message):
    sec: int
    nanosec: int
    def __init__(self, *, sec: int = ..., nanosec: int = ...) -> None: ...

class Time(base.Message):
    sec: int
    nanosec: int
    def __init__(self, *, sec: int = ..., nanosec: int = ...) -> None: ...
