# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.std_msgs import msg as std_msgs

class Accel(base.Message):
    linear: Vector3
    angular: Vector3
    def __init__(
        self,
        *,
        linear: Vector3 | Mapping[str, object] = ...,
        angular: Vector3 | Mapping[str, object] = ...,
    ) -> None: ...

class AccelStamped(base.Message):
    header: std_msgs.Header
    accel: Accel
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        accel: Accel | Mapping[str, object] = ...,
    ) -> None: ...

class AccelWithCovariance(base.Message):
    accel: Accel
    covariance: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        accel: Accel | Mapping[str, object] = ...,
        covariance: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class AccelWithCovarianceStamped(base.Message):
    header: std_msgs.Header
    accel: AccelWithCovariance
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        accel: AccelWithCovariance | Mapping[str, object] = ...,
    ) -> None: ...

class Inertia(base.Message):
    m: float
    com: Vector3
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    def __init__(
        self,
        *,
        m: float = ...,
        com: Vector3 | Mapping[str, object] = ...,
        ixx: float = ...,
        ixy: float = ...,
        ixz: float = ...,
        iyy: float = ...,
        iyz: float = ...,
        izz: float = ...,
    ) -> None: ...

class InertiaStamped(base.Message):
    header: std_msgs.Header
    inertia: Inertia
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        inertia: Inertia | Mapping[str, object] = ...,
    ) -> None: ...

class Point(base.Message):
    x: float
    y: float
    z: float
    def __init__(self, *, x: float = ..., y: float = ..., z: float = ...) -> None: ...

class Point32(base.Message):
    x: float
    y: float
    z: float
    def __init__(self, *, x: float = ..., y: float = ..., z: float = ...) -> None: ...

class PointStamped(base.Message):
    header: std_msgs.Header
    point: Point
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        point: Point | Mapping[str, object] = ...,
    ) -> None: ...

class Polygon(base.Message):
    points: list[Point32]
    def __init__(self, *, points: Sequence[Point32 | Mapping[str, object]] = ...) -> None: ...

class PolygonInstance(base.Message):
    polygon: Polygon
    id: int
    def __init__(self, *, polygon: Polygon | Mapping[str, object] = ..., id: int = ...) -> None: ...

class PolygonInstanceStamped(base.Message):
    header: std_msgs.Header
    polygon: PolygonInstance
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        polygon: PolygonInstance | Mapping[str, object] = ...,
    ) -> None: ...

class PolygonStamped(base.Message):
    header: std_msgs.Header
    polygon: Polygon
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        polygon: Polygon | Mapping[str, object] = ...,
    ) -> None: ...

class Pose(base.Message):
    position: Point
    orientation: Quaternion
    def __init__(
        self,
        *,
        position: Point | Mapping[str, object] = ...,
        orientation: Quaternion | Mapping[str, object] = ...,
    ) -> None: ...

class Pose2D(base.Message):
    x: float
    y: float
    theta: float
    def __init__(self, *, x: float = ..., y: float = ..., theta: float = ...) -> None: ...

class PoseArray(base.Message):
    header: std_msgs.Header
    poses: list[Pose]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        poses: Sequence[Pose | Mapping[str, object]] = ...,
    ) -> None: ...

class PoseStamped(base.Message):
    header: std_msgs.Header
    pose: Pose
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: Pose | Mapping[str, object] = ...,
    ) -> None: ...

class PoseWithCovariance(base.Message):
    pose: Pose
    covariance: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        pose: Pose | Mapping[str, object] = ...,
        covariance: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class PoseWithCovarianceStamped(base.Message):
    header: std_msgs.Header
    pose: PoseWithCovariance
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: PoseWithCovariance | Mapping[str, object] = ...,
    ) -> None: ...

class Quaternion(base.Message):
    x: float
    y: float
    z: float
    w: float
    def __init__(self, *, x: float = ..., y: float = ..., z: float = ..., w: float = ...) -> None: ...

class QuaternionStamped(base.Message):
    header: std_msgs.Header
    quaternion: Quaternion
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        quaternion: Quaternion | Mapping[str, object] = ...,
    ) -> None: ...

class Transform(base.Message):
    translation: Vector3
    rotation: Quaternion
    def __init__(
        self,
        *,
        translation: Vector3 | Mapping[str, object] = ...,
        rotation: Quaternion | Mapping[str, object] = ...,
    ) -> None: ...

class TransformStamped(base.Message):
    header: std_msgs.Header
    child_frame_id: str
    transform: Transform
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        child_frame_id: str = ...,
        transform: Transform | Mapping[str, object] = ...,
    ) -> None: ...

class Twist(base.Message):
    linear: Vector3
    angular: Vector3
    def __init__(
        self,
        *,
        linear: Vector3 | Mapping[str, object] = ...,
        angular: Vector3 | Mapping[str, object] = ...,
    ) -> None: ...

class TwistStamped(base.Message):
    header: std_msgs.Header
    twist: Twist
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        twist: Twist | Mapping[str, object] = ...,
    ) -> None: ...

class TwistWithCovariance(base.Message):
    twist: Twist
    covariance: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        twist: Twist | Mapping[str, object] = ...,
        covariance: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class TwistWithCovarianceStamped(base.Message):
    header: std_msgs.Header
    twist: TwistWithCovariance
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        twist: TwistWithCovariance | Mapping[str, object] = ...,
    ) -> None: ...

class Vector3(base.Message):
    x: float
    y: float
    z: float
    def __init__(self, *, x: float = ..., y: float = ..., z: float = ...) -> None: ...

class Vector3Stamped(base.Message):
    header: std_msgs.Header
    vector: Vector3
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        vector: Vector3 | Mapping[str, object] = ...,
    ) -> None: ...

class VelocityStamped(base.Message):
    header: std_msgs.Header
    body_frame_id: str
    reference_frame_id: str
    velocity: Twist
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        body_frame_id: str = ...,
        reference_frame_id: str = ...,
        velocity: Twist | Mapping[str, object] = ...,
    ) -> None: ...

class VelocityWithCovarianceStamped(base.Message):
    header: std_msgs.Header
    body_frame_id: str
    reference_frame_id: str
    velocity: TwistWithCovariance
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        body_frame_id: str = ...,
        reference_frame_id: str = ...,
        velocity: TwistWithCovariance | Mapping[str, object] = ...,
    ) -> None: ...

class Wrench(base.Message):
    force: Vector3
    torque: Vector3
    def __init__(
        self,
        *,
        force: Vector3 | Mapping[str, object] = ...,
        torque: Vector3 | Mapping[str, object] = ...,
    ) -> None: ...

class WrenchStamped(base.Message):
    header: std_msgs.Header
    wrench: Wrench
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        wrench: Wrench | Mapping[str, object] = ...,
    ) -> None: ...
