# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.std_msgs import msg as std_msgs
from graphflow.msgs.unique_identifier_msgs import msg as unique_identifier_msgs

class BoundingBox(base.Message):
    min_pt: GeoPoint
    max_pt: GeoPoint
    def __init__(
        self,
        *,
        min_pt: GeoPoint | Mapping[str, object] = ...,
        max_pt: GeoPoint | Mapping[str, object] = ...,
    ) -> None: ...

class GeoPath(base.Message):
    header: std_msgs.Header
    poses: list[GeoPoseStamped]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        poses: Sequence[GeoPoseStamped | Mapping[str, object]] = ...,
    ) -> None: ...

class GeoPoint(base.Message):
    latitude: float
    longitude: float
    altitude: float
    def __init__(self, *, latitude: float = ..., longitude: float = ..., altitude: float = ...) -> None: ...

class GeoPointStamped(base.Message):
    header: std_msgs.Header
    position: GeoPoint
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        position: GeoPoint | Mapping[str, object] = ...,
    ) -> None: ...

class GeoPose(base.Message):
    position: GeoPoint
    orientation: geometry_msgs.Quaternion
    def __init__(
        self,
        *,
        position: GeoPoint | Mapping[str, object] = ...,
        orientation: geometry_msgs.Quaternion | Mapping[str, object] = ...,
    ) -> None: ...

class GeoPoseStamped(base.Message):
    header: std_msgs.Header
    pose: GeoPose
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: GeoPose | Mapping[str, object] = ...,
    ) -> None: ...

class GeoPoseWithCovariance(base.Message):
    pose: GeoPose
    covariance: npt.NDArray[np.float64]
    def __init__(
        self,
        *,
        pose: GeoPose | Mapping[str, object] = ...,
        covariance: Sequence[float] | npt.NDArray[np.floating | np.integer] = ...,
    ) -> None: ...

class GeoPoseWithCovarianceStamped(base.Message):
    header: std_msgs.Header
    pose: GeoPoseWithCovariance
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: GeoPoseWithCovariance | Mapping[str, object] = ...,
    ) -> None: ...

class GeographicMap(base.Message):
    header: std_msgs.Header
    id: unique_identifier_msgs.UUID
    bounds: BoundingBox
    points: list[WayPoint]
    features: list[MapFeature]
    props: list[KeyValue]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        bounds: BoundingBox | Mapping[str, object] = ...,
        points: Sequence[WayPoint | Mapping[str, object]] = ...,
        features: Sequence[MapFeature | Mapping[str, object]] = ...,
        props: Sequence[KeyValue | Mapping[str, object]] = ...,
    ) -> None: ...

class GeographicMapChanges(base.Message):
    header: std_msgs.Header
    diffs: GeographicMap
    deletes: list[unique_identifier_msgs.UUID]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        diffs: GeographicMap | Mapping[str, object] = ...,
        deletes: Sequence[unique_identifier_msgs.UUID | Mapping[str, object]] = ...,
    ) -> None: ...

class KeyValue(base.Message):
    key: str
    value: str
    def __init__(self, *, key: str = ..., value: str = ...) -> None: ...

class MapFeature(base.Message):
    id: unique_identifier_msgs.UUID
    components: list[unique_identifier_msgs.UUID]
    props: list[KeyValue]
    def __init__(
        self,
        *,
        id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        components: Sequence[unique_identifier_msgs.UUID | Mapping[str, object]] = ...,
        props: Sequence[KeyValue | Mapping[str, object]] = ...,
    ) -> None: ...

class RouteNetwork(base.Message):
    header: std_msgs.Header
    id: unique_identifier_msgs.UUID
    bounds: BoundingBox
    points: list[WayPoint]
    segments: list[RouteSegment]
    props: list[KeyValue]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        bounds: BoundingBox | Mapping[str, object] = ...,
        points: Sequence[WayPoint | Mapping[str, object]] = ...,
        segments: Sequence[RouteSegment | Mapping[str, object]] = ...,
        props: Sequence[KeyValue | Mapping[str, object]] = ...,
    ) -> None: ...

class RoutePath(base.Message):
    header: std_msgs.Header
    network: unique_identifier_msgs.UUID
    segments: list[unique_identifier_msgs.UUID]
    props: list[KeyValue]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        network: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        segments: Sequence[unique_identifier_msgs.UUID | Mapping[str, object]] = ...,
        props: Sequence[KeyValue | Mapping[str, object]] = ...,
    ) -> None: ...

class RouteSegment(base.Message):
    id: unique_identifier_msgs.UUID
    start: unique_identifier_msgs.UUID
    end: unique_identifier_msgs.UUID
    props: list[KeyValue]
    def __init__(
        self,
        *,
        id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        start: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        end: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        props: Sequence[KeyValue | Mapping[str, object]] = ...,
    ) -> None: ...

class WayPoint(base.Message):
    id: unique_identifier_msgs.UUID
    position: GeoPoint
    props: list[KeyValue]
    def __init__(
        self,
        *,
        id: unique_identifier_msgs.UUID | Mapping[str, object] = ...,
        position: GeoPoint | Mapping[str, object] = ...,
        props: Sequence[KeyValue | Mapping[str, object]] = ...,
    ) -> None: ...
