# Written by `python -m graphflow.msgs.stubs`; do not edit.

from graphflow.msgs.base import Message

class Duration(Message):
    sec: int
    nanosec: int
    def __init__(self, *, sec: int = ..., nanosec: int = ...) -> None: ...

class Time(Message):
    sec: int
    nanosec: int
    def __init__(self, *, sec: int = ..., nanosec: int = ...) -> None: ...
