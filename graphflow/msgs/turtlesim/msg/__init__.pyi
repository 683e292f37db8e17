# Written by `python -m graphflow.msgs.stubs`; do not edit.

from graphflow.msgs.base import Message

class Color(Message):
    r: int
    g: int
    b: int
    def __init__(self, *, r: int = ..., g: int = ..., b: int = ...) -> None: ...

class Pose(Message):
    x: float
    y: float
    theta: float
    linear_velocity: float
    angular_velocity: float
    def __init__(
        self,
        *,
        x: float = ...,
        y: float = ...,
        theta: float = ...,
        linear_velocity: float = ...,
        angular_velocity: float = ...,
    ) -> None: ...
