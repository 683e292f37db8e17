# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class BoundingBox2D(base.Message):
    center: Pose2D
    size_x: float
    size_y: float
    def __init__(
        self,
        *,
        center: Pose2D | Mapping[str, object] = ...,
        size_x: float = ...,
        size_y: float = ...,
    ) -> None: ...

class BoundingBox2DArray(base.Message):
    header: std_msgs.Header
    boxes: list[BoundingBox2D]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        boxes: Sequence[BoundingBox2D | Mapping[str, object]] = ...,
    ) -> None: ...

class BoundingBox3D(base.Message):
    center: geometry_msgs.Pose
    size: geometry_msgs.Vector3
    def __init__(
        self,
        *,
        center: geometry_msgs.Pose | Mapping[str, object] = ...,
        size: geometry_msgs.Vector3 | Mapping[str, object] = ...,
    ) -> None: ...

class BoundingBox3DArray(base.Message):
    header: std_msgs.Header
    boxes: list[BoundingBox3D]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        boxes: Sequence[BoundingBox3D | Mapping[str, object]] = ...,
    ) -> None: ...

class Classification(base.Message):
    header: std_msgs.Header
    results: list[ObjectHypothesis]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        results: Sequence[ObjectHypothesis | Mapping[str, object]] = ...,
    ) -> None: ...

class Detection2D(base.Message):
    header: std_msgs.Header
    results: list[ObjectHypothesisWithPose]
    bbox: BoundingBox2D
    id: str
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        results: Sequence[ObjectHypothesisWithPose | Mapping[str, object]] = ...,
        bbox: BoundingBox2D | Mapping[str, object] = ...,
        id: str = ...,
    ) -> None: ...

class Detection2DArray(base.Message):
    header: std_msgs.Header
    detections: list[Detection2D]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        detections: Sequence[Detection2D | Mapping[str, object]] = ...,
    ) -> None: ...

class Detection3D(base.Message):
    header: std_msgs.Header
    results: list[ObjectHypothesisWithPose]
    bbox: BoundingBox3D
    id: str
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        results: Sequence[ObjectHypothesisWithPose | Mapping[str, object]] = ...,
        bbox: BoundingBox3D | Mapping[str, object] = ...,
        id: str = ...,
    ) -> None: ...

class Detection3DArray(base.Message):
    header: std_msgs.Header
    detections: list[Detection3D]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        detections: Sequence[Detection3D | Mapping[str, object]] = ...,
    ) -> None: ...

class LabelInfo(base.Message):
    header: std_msgs.Header
    class_map: list[VisionClass]
    threshold: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        class_map: Sequence[VisionClass | Mapping[str, object]] = ...,
        threshold: float = ...,
    ) -> None: ...

class ObjectHypothesis(base.Message):
    class_id: str
    score: float
    def __init__(self, *, class_id: str = ..., score: float = ...) -> None: ...

class ObjectHypothesisWithPose(base.Message):
    hypothesis: ObjectHypothesis
    pose: geometry_msgs.PoseWithCovariance
    def __init__(
        self,
        *,
        hypothesis: ObjectHypothesis | Mapping[str, object] = ...,
        pose: geometry_msgs.PoseWithCovariance | Mapping[str, object] = ...,
    ) -> None: ...

class Point2D(base.Message):
    x: float
    y: float
    def __init__(self, *, x: float = ..., y: float = ...) -> None: ...

class Pose2D(base.Message):
    position: Point2D
    theta: float
    def __init__(self, *, position: Point2D | Mapping[str, object] = ..., theta: float = ...) -> None: ...

class VisionClass(base.Message):
    class_id: int
    class_name: str
    def __init__(self, *, class_id: int = ..., class_name: str = ...) -> None: ...

class VisionInfo(base.Message):
    header: std_msgs.Header
    method: str
    database_location: str
    database_version: int
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        method: str = ...,
        database_location: str = ...,
        database_version: int = ...,
    ) -> None: ...
