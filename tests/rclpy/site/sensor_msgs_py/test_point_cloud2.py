"""Point clouds as arrays."""

from __future__ import annotations

import numpy as np
import pytest
from sensor_msgs.msg import PointCloud2, PointField
from sensor_msgs_py import point_cloud2
from std_msgs.msg import Header

FIELDS = [
    PointField(name="x", offset=0, datatype=PointField.FLOAT32, count=1),
    PointField(name="ring", offset=4, datatype=PointField.UINT16, count=1),
    PointField(name="rgb", offset=8, datatype=PointField.UINT8, count=3),
]


def test_a_cloud_there_and_back() -> None:
    """With fields of several types, gaps between them, and points without a number."""
    rows = [(1.5, 1, 10, 20, 30), (float("nan"), 2, 0, 0, 0), (2.5, 3, 40, 50, 60)]
    cloud = point_cloud2.create_cloud(Header(frame_id="laser"), FIELDS, rows)
    assert (cloud.header.frame_id, cloud.height, cloud.width, cloud.point_step) == ("laser", 1, 3, 11)
    points = point_cloud2.read_points(cloud)
    assert points.dtype.names == ("x", "ring", "rgb_0", "rgb_1", "rgb_2")
    assert points["ring"].tolist() == [1, 2, 3]
    assert points["rgb_1"].tolist() == [20, 0, 50]
    kept = point_cloud2.read_points(cloud, ["x", "ring"], skip_nans=True)
    assert kept.tolist() == [(1.5, 1), (2.5, 3)]
    named = point_cloud2.read_points_list(cloud, ["ring", "x"], uvs=[2])
    assert (named[0].ring, named[0].x) == (3, 2.5)
    again = point_cloud2.create_cloud(cloud.header, FIELDS, points)
    assert again == cloud


def test_x_y_and_z() -> None:
    """The usual cloud; and an organized one, of which columns and rows are picked."""
    rows = np.arange(12, dtype=np.float32).reshape(4, 3)
    cloud = point_cloud2.create_cloud_xyz32(Header(), rows)
    assert (cloud.row_step, len(cloud.data)) == (48, 48)
    assert point_cloud2.read_points_numpy(cloud).tolist() == rows.tolist()
    more = np.arange(18, dtype=np.float32).reshape(2, 3, 3)
    organized = point_cloud2.create_cloud_xyz32(Header(), more)
    assert (organized.width, organized.height, organized.row_step) == (2, 3, 24)
    read = point_cloud2.read_points(organized, reshape_organized_cloud=True)
    assert read["x"].tolist() == more[:, :, 0].tolist()
    assert point_cloud2.read_points(organized, ["x"], uvs=[(1, 2)])["x"].tolist() == [15]
    assert point_cloud2.read_points(point_cloud2.create_cloud_xyz32(Header(), [])).tolist() == []


def test_clouds_of_others() -> None:
    """The bytes of each number may stand the other way round, and rows may be filled up."""
    data = np.array([1.0, 2.0], dtype=">f4").tobytes()
    cloud = PointCloud2(fields=FIELDS[:1], point_step=4, height=2, width=1, row_step=6, is_bigendian=True)
    cloud.data = data[:4] + b"??" + data[4:] + b"??"
    assert point_cloud2.read_points(cloud)["x"].tolist() == [1, 2]


def test_what_is_wrong_is_told() -> None:
    """A field that is not there, too few bytes, rows of the wrong length, several types in one array."""
    cloud = point_cloud2.create_cloud(Header(), FIELDS, [(1, 2, 3, 4, 5)])
    with pytest.raises(ValueError, match="no field 'y'; it has x, ring, rgb_0"):
        point_cloud2.read_points(cloud, ["y"])
    with pytest.raises(ValueError, match="same datatype"):
        point_cloud2.read_points_numpy(cloud)
    with pytest.raises(ValueError, match="have 2 values each, but the cloud has 5 fields"):
        point_cloud2.create_cloud(Header(), FIELDS, [(1, 2)])
    cloud.width = 1000
    with pytest.raises(ValueError, match=r"1 x 1000 points has only 11 bytes"):
        point_cloud2.read_points(cloud)
