"""Conversion between point clouds and NumPy arrays."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured
from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

_DATATYPES: dict[int, Any] = {
    PointField.INT8: np.int8,
    PointField.UINT8: np.uint8,
    PointField.INT16: np.int16,
    PointField.UINT16: np.uint16,
    PointField.INT32: np.int32,
    PointField.UINT32: np.uint32,
    PointField.FLOAT32: np.float32,
    PointField.FLOAT64: np.float64,
}
DUMMY_FIELD_PREFIX = "unnamed_field"


def dtype_from_fields(fields: Iterable[PointField], point_step: int | None = None) -> np.dtype[Any]:
    """Return the dtype of one point of a cloud.

    Args:
        point_step: Bytes from one point to the next; None for as many as the fields need.
    """
    names, offsets, kinds = [], [], []
    for number, field in enumerate(fields):
        base = np.dtype(_DATATYPES[field.datatype])
        name = field.name or f"{DUMMY_FIELD_PREFIX}_{number}"
        for i in range(field.count):
            names.append(name if field.count == 1 else f"{name}_{i}")
            offsets.append(field.offset + i * base.itemsize)
            kinds.append(base)
    spec: dict[str, Any] = {"names": names, "formats": kinds, "offsets": offsets}
    if point_step is not None:
        spec["itemsize"] = point_step
    return np.dtype(spec)  # type: ignore[call-overload, no-any-return]  # numpy's stubs lack this form


def read_points(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[object] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Read the points of a cloud into a structured array, one field for each of the cloud's.

    Args:
        field_names: The fields to read; None for all.
        skip_nans: Whether to leave out points with a NaN.
        uvs: The indices, or the columns and rows, of the points to read; None for all.
        reshape_organized_cloud: Whether an organized cloud has the shape (width, height).

    Raises:
        ValueError: The cloud has no such field, or fewer bytes than its dimensions need.
    """
    dtype = dtype_from_fields(cloud.fields, cloud.point_step)
    points = _points(cloud, dtype)
    if bool(sys.byteorder != "little") != bool(cloud.is_bigendian):
        points = points.byteswap()
    if field_names is not None:
        missing = [name for name in field_names if name not in (dtype.names or ())]
        if missing:
            raise ValueError(f"the cloud has no field {missing[0]!r}; it has {', '.join(dtype.names or ())}")
        points = points[list(field_names)]
    if skip_nans and not cloud.is_dense:
        kept = np.ones(len(points), dtype=bool)
        for name in points.dtype.names or ():
            kept &= ~np.isnan(points[name])
        points = points[kept]
    if uvs is not None:
        wanted = np.asarray(list(uvs))
        points = points[wanted if wanted.ndim == 1 else wanted[:, 1] * cloud.width + wanted[:, 0]]
    if reshape_organized_cloud and cloud.height > 1:
        points = points.reshape(cloud.width, cloud.height)  # as ROS 2 has it
    return points


def _points(cloud: PointCloud2, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return all points without the padding of rows."""
    data = np.frombuffer(memoryview(cloud.data), dtype=np.uint8)
    row = cloud.point_step * cloud.width
    step = cloud.row_step or row
    if step < row or len(data) < step * cloud.height:
        raise ValueError(f"a cloud of {cloud.height} x {cloud.width} points has only {len(data)} bytes")
    if step != row:
        data = np.ascontiguousarray(data[: step * cloud.height].reshape(cloud.height, step)[:, :row]).ravel()
    return data[: row * cloud.height].view(dtype)


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[object] | None = None,
    reshape_organized_cloud: bool = False,
) -> NDArray[Any]:
    """Read the points into a plain array of shape (points, fields).

    Raises:
        ValueError: As for `read_points`; or the fields are of several types.
    """
    wanted = [f.name for f in cloud.fields] if field_names is None else field_names
    if len({f.datatype for f in cloud.fields if f.name in wanted}) > 1:
        raise ValueError("All fields need to have the same datatype. Use `read_points()` otherwise.")
    return structured_to_unstructured(read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud))


def read_points_list(
    cloud: PointCloud2,
    field_names: Sequence[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[object] | None = None,
) -> list[Any]:
    """Read the points into a list of named tuples."""
    points = read_points(cloud, field_names, skip_nans, uvs)
    make = NamedTuple("Point", [(name, Any) for name in points.dtype.names or ()])  # type: ignore[misc]
    return [make(*values) for values in points.tolist()]


def create_cloud(
    header: Header, fields: Iterable[PointField], points: Any, step: int | None = None, point_step: int | None = None
) -> PointCloud2:
    """Create a cloud of points.

    Args:
        points: A structured array; or rows of numbers, in the order of the fields. Of two dimensions (of three, for
            rows) it is an organized cloud; the first is its width, as ROS 2 has it.
        step: Bytes from one point to the next; None for as many as the fields need. `point_step` is a synonym.

    Raises:
        ValueError: The length of the rows differs from the number of fields.
    """
    fields = list(fields)
    dtype = dtype_from_fields(fields, step if step is not None else point_step)
    array = points if isinstance(points, np.ndarray) else np.asarray(list(points))
    if array.dtype.names is None:
        width = len(dtype.names or ())
        array = array.reshape(0, width) if array.size == 0 else array
        if array.shape[-1] != width:
            raise ValueError(f"points have {array.shape[-1]} values each, but the cloud has {width} fields")
        array = unstructured_to_structured(array, dtype)
    elif array.dtype != dtype:
        array = array.astype(dtype)
    width, height = array.shape if array.ndim == 2 else (len(array), 1)
    return PointCloud2(
        header=header,
        height=height,
        width=width,
        is_dense=False,
        is_bigendian=sys.byteorder != "little",
        fields=fields,
        point_step=dtype.itemsize,
        row_step=dtype.itemsize * width,
        data=np.ascontiguousarray(array).tobytes(),
    )


def create_cloud_xyz32(header: Header, points: object, step: int | None = None) -> PointCloud2:
    """Create a cloud of points with x, y and z, each a 32-bit float."""
    fields = [PointField(name=n, offset=4 * i, datatype=PointField.FLOAT32, count=1) for i, n in enumerate("xyz")]
    return create_cloud(header, fields, np.asarray(points, dtype=np.float32), step)
