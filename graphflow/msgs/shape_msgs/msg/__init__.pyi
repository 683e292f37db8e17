# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import Final

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
    BOX: Final = 1
    SPHERE: Final = 2
    CYLINDER: Final = 3
    CONE: Final = 4
    PRISM: Final = 5
    BOX_X: Final = 0
    BOX_Y: Final = 1
    BOX_Z: Final = 2
    SPHERE_RADIUS: Final = 0
    CYLINDER_HEIGHT: Final = 0
    CYLINDER_RADIUS: Final = 1
    CONE_HEIGHT: Final = 0
    CONE_RADIUS: Final = 1
    PRISM_HEIGHT: Final = 0
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
