"""Images, point clouds, scans and maps as numpy arrays: views of the message's own bytes, without copies.

Source: sensor_msgs/image_encodings.hpp; sensor_msgs/msg/PointCloud2 and PointField.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from graphflow.errors import DecodeError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from graphflow.msgs.nav_msgs.msg import OccupancyGrid
    from graphflow.msgs.sensor_msgs.msg import Image, LaserScan, PointCloud2

_ENCODINGS = {
    **{f"{order}{bits}": (len(order), f"u{bits // 8}") for order in ("rgb", "bgr", "rgba", "bgra") for bits in (8, 16)},
    **{f"mono{bits}": (1, f"u{bits // 8}") for bits in (8, 16)},
    **{f"bayer_{p}{bits}": (1, f"u{bits // 8}") for p in ("rggb", "bggr", "gbrg", "grbg") for bits in (8, 16)},
    **dict.fromkeys(("yuv422", "yuv422_yuy2", "uyvy", "yuyv"), (2, "u1")),
}
"""Number of channels and element type by encoding."""
_OPENCV = re.compile(r"(8|16|32|64)([USF])C([1-9]\d*)?\Z")
"""OpenCV's names of encodings, such as 32FC1."""
_OPENCV_KINDS = {"U": "u", "S": "i", "F": "f"}
_POINT_TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8", 9: "i8", 10: "u8", 11: "?"}
"""Element type by PointField.datatype."""


def _elements(encoding: str) -> tuple[int, str]:
    if encoding in _ENCODINGS:
        return _ENCODINGS[encoding]
    found = _OPENCV.match(encoding)
    if not found:
        raise DecodeError(f"Image.encoding: {encoding!r} is not known, only {', '.join(_ENCODINGS)}; read Image.data")
    bits, kind, channels = found.groups()
    return int(channels or 1), f"{_OPENCV_KINDS[kind]}{int(bits) // 8}"


def image(message: Image) -> NDArray[Any]:
    """Return the pixels of a sensor_msgs/msg/Image.

    Returns:
        Array of shape (height, width), or (height, width, channels) if there are several, in the encoding's element
        type and the order of its channels. A view of `data`, read-only if the message was received.

    Raises:
        DecodeError: The encoding is not known, or `data` is shorter than height and step imply.
    """
    import numpy as np

    channels, kind = _elements(message.encoding)
    dtype = np.dtype((">" if message.is_bigendian else "<") + kind)
    pixel = channels * dtype.itemsize
    shape: tuple[int, ...] = (message.height, message.width)
    strides: tuple[int, ...] = (message.step, pixel)
    if channels > 1:
        shape, strides = (*shape, channels), (*strides, dtype.itemsize)
    return _view("Image", message.data, dtype, shape, strides)


def point_cloud(message: PointCloud2) -> NDArray[Any]:
    """Return the points of a sensor_msgs/msg/PointCloud2.

    Returns:
        Structured array with the message's fields, of shape (width,), or (height, width) for an organised cloud:
        `points["x"]`. A view of `data`.

    Raises:
        DecodeError: A field has an unknown type or lies outside the point, or `data` is too short.
    """
    import numpy as np

    order = ">" if message.is_bigendian else "<"
    names, formats, offsets = [], [], []
    for field in message.fields:
        if field.datatype not in _POINT_TYPES:
            raise DecodeError(f"PointCloud2.fields: {field.name!r} has datatype {field.datatype}, which does not exist")
        names.append(field.name)
        formats.append(
            (order + _POINT_TYPES[field.datatype], (field.count,))
            if field.count > 1
            else (order + _POINT_TYPES[field.datatype])
        )
        offsets.append(field.offset)
    try:
        dtype = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": message.point_step})
    except ValueError as error:
        raise DecodeError(f"PointCloud2.fields: {error}") from None
    shape, strides = (message.height, message.width), (message.row_step, message.point_step)
    points = _view("PointCloud2", message.data, dtype, shape, strides)
    return points[0] if message.height == 1 else points


def scan(message: LaserScan) -> NDArray[np.float32]:
    """Return the ranges of a sensor_msgs/msg/LaserScan in metres: the message's own array, of shape (rays,)."""
    ranges: NDArray[np.float32] = message.ranges
    return ranges


def grid(message: OccupancyGrid) -> NDArray[np.int8]:
    """Return the cells of a nav_msgs/msg/OccupancyGrid: array of shape (height, width), row 0 at the origin; a view.

    Raises:
        DecodeError: `data` has fewer cells than width and height imply.
    """
    import numpy as np

    info = message.info
    return _view("OccupancyGrid", message.data, np.dtype(np.int8), (info.height, info.width), (info.width, 1))


def _view(what: str, data: Any, dtype: np.dtype[Any], shape: tuple[int, ...], strides: tuple[int, ...]) -> NDArray[Any]:
    """Return an array over `data`, which must be long enough for its last element."""
    import numpy as np

    if 0 in shape:
        return np.zeros(shape, dtype)
    needed = sum((n - 1) * stride for n, stride in zip(shape, strides, strict=True)) + dtype.itemsize
    if any(stride < inner for stride, inner in zip(strides, strides[1:], strict=False)) or needed > data.nbytes:
        raise DecodeError(
            f"{what}.data: {shape} elements with steps of {strides} bytes need {needed} bytes, not {data.nbytes}"
        )
    return np.ndarray(shape, dtype, data, strides=strides)


VIEWS: dict[str, Callable[[Any], Any]] = {
    "sensor_msgs/msg/Image": image,
    "sensor_msgs/msg/PointCloud2": point_cloud,
    "sensor_msgs/msg/LaserScan": scan,
    "nav_msgs/msg/OccupancyGrid": grid,
}
"""Functions behind `to_numpy`, by message type."""
