# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs import base
from graphflow.msgs.builtin_interfaces import msg as builtin_interfaces
from graphflow.msgs.geometry_msgs import msg as geometry_msgs
from graphflow.msgs.sensor_msgs import msg as sensor_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class ImageMarker(base.Message):
    CIRCLE: ClassVar[Literal[0]]
    LINE_STRIP: ClassVar[Literal[1]]
    LINE_LIST: ClassVar[Literal[2]]
    POLYGON: ClassVar[Literal[3]]
    POINTS: ClassVar[Literal[4]]
    ADD: ClassVar[Literal[0]]
    REMOVE: ClassVar[Literal[1]]
    header: std_msgs.Header
    ns: str
    id: int
    type: int
    action: int
    position: geometry_msgs.Point
    scale: float
    outline_color: std_msgs.ColorRGBA
    filled: int
    fill_color: std_msgs.ColorRGBA
    lifetime: builtin_interfaces.Duration
    points: list[geometry_msgs.Point]
    outline_colors: list[std_msgs.ColorRGBA]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        ns: str = ...,
        id: int = ...,
        type: int = ...,
        action: int = ...,
        position: geometry_msgs.Point | Mapping[str, object] = ...,
        scale: float = ...,
        outline_color: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        filled: int = ...,
        fill_color: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        lifetime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        points: Sequence[geometry_msgs.Point | Mapping[str, object]] = ...,
        outline_colors: Sequence[std_msgs.ColorRGBA | Mapping[str, object]] = ...,
    ) -> None: ...

class InteractiveMarker(base.Message):
    header: std_msgs.Header
    pose: geometry_msgs.Pose
    name: str
    description: str
    scale: float
    menu_entries: list[MenuEntry]
    controls: list[InteractiveMarkerControl]
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        name: str = ...,
        description: str = ...,
        scale: float = ...,
        menu_entries: Sequence[MenuEntry | Mapping[str, object]] = ...,
        controls: Sequence[InteractiveMarkerControl | Mapping[str, object]] = ...,
    ) -> None: ...

class InteractiveMarkerControl(base.Message):
    INHERIT: ClassVar[Literal[0]]
    FIXED: ClassVar[Literal[1]]
    VIEW_FACING: ClassVar[Literal[2]]
    NONE: ClassVar[Literal[0]]
    MENU: ClassVar[Literal[1]]
    BUTTON: ClassVar[Literal[2]]
    MOVE_AXIS: ClassVar[Literal[3]]
    MOVE_PLANE: ClassVar[Literal[4]]
    ROTATE_AXIS: ClassVar[Literal[5]]
    MOVE_ROTATE: ClassVar[Literal[6]]
    MOVE_3D: ClassVar[Literal[7]]
    ROTATE_3D: ClassVar[Literal[8]]
    MOVE_ROTATE_3D: ClassVar[Literal[9]]
    name: str
    orientation: geometry_msgs.Quaternion
    orientation_mode: int
    interaction_mode: int
    always_visible: bool
    markers: list[Marker]
    independent_marker_orientation: bool
    description: str
    def __init__(
        self,
        *,
        name: str = ...,
        orientation: geometry_msgs.Quaternion | Mapping[str, object] = ...,
        orientation_mode: int = ...,
        interaction_mode: int = ...,
        always_visible: bool = ...,
        markers: Sequence[Marker | Mapping[str, object]] = ...,
        independent_marker_orientation: bool = ...,
        description: str = ...,
    ) -> None: ...

class InteractiveMarkerFeedback(base.Message):
    KEEP_ALIVE: ClassVar[Literal[0]]
    POSE_UPDATE: ClassVar[Literal[1]]
    MENU_SELECT: ClassVar[Literal[2]]
    BUTTON_CLICK: ClassVar[Literal[3]]
    MOUSE_DOWN: ClassVar[Literal[4]]
    MOUSE_UP: ClassVar[Literal[5]]
    header: std_msgs.Header
    client_id: str
    marker_name: str
    control_name: str
    event_type: int
    pose: geometry_msgs.Pose
    menu_entry_id: int
    mouse_point: geometry_msgs.Point
    mouse_point_valid: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        client_id: str = ...,
        marker_name: str = ...,
        control_name: str = ...,
        event_type: int = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        menu_entry_id: int = ...,
        mouse_point: geometry_msgs.Point | Mapping[str, object] = ...,
        mouse_point_valid: bool = ...,
    ) -> None: ...

class InteractiveMarkerInit(base.Message):
    server_id: str
    seq_num: int
    markers: list[InteractiveMarker]
    def __init__(
        self,
        *,
        server_id: str = ...,
        seq_num: int = ...,
        markers: Sequence[InteractiveMarker | Mapping[str, object]] = ...,
    ) -> None: ...

class InteractiveMarkerPose(base.Message):
    header: std_msgs.Header
    pose: geometry_msgs.Pose
    name: str
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        name: str = ...,
    ) -> None: ...

class InteractiveMarkerUpdate(base.Message):
    KEEP_ALIVE: ClassVar[Literal[0]]
    UPDATE: ClassVar[Literal[1]]
    server_id: str
    seq_num: int
    type: int
    markers: list[InteractiveMarker]
    poses: list[InteractiveMarkerPose]
    erases: list[str]
    def __init__(
        self,
        *,
        server_id: str = ...,
        seq_num: int = ...,
        type: int = ...,
        markers: Sequence[InteractiveMarker | Mapping[str, object]] = ...,
        poses: Sequence[InteractiveMarkerPose | Mapping[str, object]] = ...,
        erases: Sequence[str] = ...,
    ) -> None: ...

class Marker(base.Message):
    ARROW: ClassVar[Literal[0]]
    CUBE: ClassVar[Literal[1]]
    SPHERE: ClassVar[Literal[2]]
    CYLINDER: ClassVar[Literal[3]]
    LINE_STRIP: ClassVar[Literal[4]]
    LINE_LIST: ClassVar[Literal[5]]
    CUBE_LIST: ClassVar[Literal[6]]
    SPHERE_LIST: ClassVar[Literal[7]]
    POINTS: ClassVar[Literal[8]]
    TEXT_VIEW_FACING: ClassVar[Literal[9]]
    MESH_RESOURCE: ClassVar[Literal[10]]
    TRIANGLE_LIST: ClassVar[Literal[11]]
    ARROW_STRIP: ClassVar[Literal[12]]
    ADD: ClassVar[Literal[0]]
    MODIFY: ClassVar[Literal[0]]
    DELETE: ClassVar[Literal[2]]
    DELETEALL: ClassVar[Literal[3]]
    header: std_msgs.Header
    ns: str
    id: int
    type: int
    action: int
    pose: geometry_msgs.Pose
    scale: geometry_msgs.Vector3
    color: std_msgs.ColorRGBA
    lifetime: builtin_interfaces.Duration
    frame_locked: bool
    points: list[geometry_msgs.Point]
    colors: list[std_msgs.ColorRGBA]
    texture_resource: str
    texture: sensor_msgs.CompressedImage
    uv_coordinates: list[UVCoordinate]
    text: str
    mesh_resource: str
    mesh_file: MeshFile
    mesh_use_embedded_materials: bool
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        ns: str = ...,
        id: int = ...,
        type: int = ...,
        action: int = ...,
        pose: geometry_msgs.Pose | Mapping[str, object] = ...,
        scale: geometry_msgs.Vector3 | Mapping[str, object] = ...,
        color: std_msgs.ColorRGBA | Mapping[str, object] = ...,
        lifetime: builtin_interfaces.Duration | Mapping[str, object] | times.Duration = ...,
        frame_locked: bool = ...,
        points: Sequence[geometry_msgs.Point | Mapping[str, object]] = ...,
        colors: Sequence[std_msgs.ColorRGBA | Mapping[str, object]] = ...,
        texture_resource: str = ...,
        texture: sensor_msgs.CompressedImage | Mapping[str, object] = ...,
        uv_coordinates: Sequence[UVCoordinate | Mapping[str, object]] = ...,
        text: str = ...,
        mesh_resource: str = ...,
        mesh_file: MeshFile | Mapping[str, object] = ...,
        mesh_use_embedded_materials: bool = ...,
    ) -> None: ...

class MarkerArray(base.Message):
    markers: list[Marker]
    def __init__(self, *, markers: Sequence[Marker | Mapping[str, object]] = ...) -> None: ...

class MenuEntry(base.Message):
    FEEDBACK: ClassVar[Literal[0]]
    ROSRUN: ClassVar[Literal[1]]
    ROSLAUNCH: ClassVar[Literal[2]]
    id: int
    parent_id: int
    title: str
    command: str
    command_type: int
    def __init__(
        self,
        *,
        id: int = ...,
        parent_id: int = ...,
        title: str = ...,
        command: str = ...,
        command_type: int = ...,
    ) -> None: ...

class MeshFile(base.Message):
    filename: str
    data: npt.NDArray[np.uint8]
    def __init__(self, *, filename: str = ..., data: Sequence[int] | npt.NDArray[np.integer] = ...) -> None: ...

class UVCoordinate(base.Message):
    u: float
    v: float
    def __init__(self, *, u: float = ..., v: float = ...) -> None: ...
