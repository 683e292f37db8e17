# Written by `python -m graphflow.msgs.stubs`; do not edit.

from graphflow.msgs import base

class Color(base.Message):
    r: int
    g: int
    b: int
    def __init__(self, *, r: int = ..., g: int = ..., b: int = ...) -> None: ...

class Pose(base.Message):
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
