# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping

from graphflow.msgs import base
from graphflow.msgs.sensor_msgs import msg as sensor_msgs
from graphflow.msgs.std_msgs import msg as std_msgs

class DisparityImage(base.Message):
    header: std_msgs.Header
    image: sensor_msgs.Image
    f: float
    t: float
    valid_window: sensor_msgs.RegionOfInterest
    min_disparity: float
    max_disparity: float
    delta_d: float
    def __init__(
        self,
        *,
        header: std_msgs.Header | Mapping[str, object] = ...,
        image: sensor_msgs.Image | Mapping[str, object] = ...,
        f: float = ...,
        t: float = ...,
        valid_window: sensor_msgs.RegionOfInterest | Mapping[str, object] = ...,
        min_disparity: float = ...,
        max_disparity: float = ...,
        delta_d: float = ...,
    ) -> None: ...
