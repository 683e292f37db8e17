# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs

class Mesh(base.Message):
    triangles: list[MeshTriangle]
    vertices: list[geometry_msgs.Point]
    def __init__(
        self,
        *,
        triangles: Sequence[MeshTriangle | Mapping[str, object]] = ...,
        vertices: Sequence[geometry_msgs.Point | Mapping[str, object]] = ...,
    ) -> None: ...

class MeshTriangle(base.Message):
    vertex_indices: npt.NDArray[np.uint32]
    def __init__(self, *, vertex_indices: Sequence[int] | npt.NDArray[np.integer] = ...) -> None: ...

class Plane(base.Message):
    coef: npt.NDArray[np.float64]
    def __init__(self, *, coef: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...) -> None: ...

class SolidPrimitive(base.Message):
    BOX: ClassVar[Literal[1]]
    SPHERE: ClassVar[Literal[2]]
    CYLINDER: ClassVar[Literal[3]]
    CONE: ClassVar[Literal[4]]
    PRISM: ClassVar[Literal[5]]
    BOX_X: ClassVar[Literal[0]]
    BOX_Y: ClassVar[Literal[1]]
    BOX_Z: ClassVar[Literal[2]]
    SPHERE_RADIUS: ClassVar[Literal[0]]
    CYLINDER_HEIGHT: ClassVar[Literal[0]]
    CYLINDER_RADIUS: ClassVar[Literal[1]]
    CONE_HEIGHT: ClassVar[Literal[0]]
    CONE_RADIUS: ClassVar[Literal[1]]
    PRISM_HEIGHT: ClassVar[Literal[0]]
    type: int
    dimensions: npt.NDArray[np.float64]
    polygon: geometry_msgs.Polygon
    def __init__(
        self,
        *,
        type: int = ...,
        dimensions: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
        polygon: geometry_msgs.Polygon | Mapping[str, object] = ...,
    ) -> None: ...
