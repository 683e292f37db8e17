"""Messages as numpy arrays: the right shape and values, the message's own bytes, and nothing beyond them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from graphflow.errors import DecodeError
from graphflow.msgs.nav_msgs.msg import MapMetaData, OccupancyGrid
from graphflow.msgs.sensor_msgs.msg import Image, LaserScan, PointCloud2, PointField


def picture(encoding: str, step: int, data: Any, *, height: int = 2, width: int = 3, big: int = 0) -> Image:
    return Image(height=height, width=width, encoding=encoding, step=step, data=data, is_bigendian=big)


@pytest.mark.parametrize(
    ("encoding", "shape", "dtype"),
    [
        ("mono8", (2, 3), "u1"),
        ("rgb8", (2, 3, 3), "u1"),
        ("bgra8", (2, 3, 4), "u1"),
        ("mono16", (2, 3), "<u2"),
        ("rgb16", (2, 3, 3), "<u2"),
        ("bayer_rggb8", (2, 3), "u1"),
        ("yuv422", (2, 3, 2), "u1"),
        ("32FC1", (2, 3), "<f4"),
        ("64FC", (2, 3), "<f8"),
        ("16SC2", (2, 3, 2), "<i2"),
    ],
)
def test_an_image_is_rows_of_pixels(encoding: str, shape: tuple[int, ...], dtype: str) -> None:
    """Shape and type follow the encoding, and padding at the ends of rows is left out."""
    pixels = np.arange(np.prod(shape)).astype(dtype).reshape(shape)
    row = pixels[0].nbytes
    padded = b"".join(r.tobytes() + b"\xee" * 5 for r in pixels)
    found = picture(encoding, row + 5, padded).to_numpy()
    assert found.dtype == np.dtype(dtype)
    np.testing.assert_array_equal(found, pixels)


def test_a_big_endian_image_is_read_as_such() -> None:
    """By its flag."""
    assert picture("mono16", 6, bytes(range(12)), big=1).to_numpy()[0, 1] == 0x0203


def test_nothing_is_copied() -> None:
    """The array is the message's memory; that of a received message cannot be written."""
    image = picture("rgb8", 9, np.zeros(18, np.uint8))
    image.to_numpy()[1, 2, 0] = 7
    assert image.data[15] == 7
    received = Image.from_bytes(image.to_bytes())
    view = received.to_numpy()
    assert np.shares_memory(view, received.data)
    with pytest.raises(ValueError, match="read-only"):
        view[0, 0, 0] = 1


@pytest.mark.parametrize(
    ("image", "text"),
    [
        (picture("jpeg?", 9, bytes(18)), r"Image\.encoding: 'jpeg\?' is not known"),
        (picture("rgb8", 9, bytes(17)), r"Image.data: \(2, 3, 3\) elements .* need 18 bytes, not 17"),
        (picture("rgb8", 3, bytes(18)), r"Image\.data: .* steps of"),
        (picture("64FC4", 2**31, bytes(18), height=2**31, width=2**31), r"Image\.data: .* need"),
    ],
)
def test_an_image_that_contradicts_itself_is_refused(image: Image, text: str) -> None:
    """Whatever a peer claims, no byte outside the message is read."""
    if "steps" in text:
        image.step = 2
    with pytest.raises(DecodeError, match=text):
        image.to_numpy()


def test_an_empty_image_is_an_empty_array() -> None:
    """Of the right shape."""
    assert picture("rgb8", 0, b"", height=0, width=0).to_numpy().shape == (0, 0, 3)


def cloud(height: int = 1, width: int = 2, **changes: Any) -> PointCloud2:
    fields = [
        PointField(name="x", offset=0, datatype=PointField.FLOAT32, count=1),
        PointField(name="y", offset=4, datatype=PointField.FLOAT32, count=1),
        PointField(name="rgb", offset=10, datatype=PointField.UINT8, count=3),
        PointField(name="ring", offset=14, datatype=PointField.UINT16, count=1),
    ]
    dtype = np.dtype(
        {
            "names": ["x", "y", "rgb", "ring"],
            "formats": ["<f4", "<f4", "3u1", "<u2"],
            "offsets": [0, 4, 10, 14],
            "itemsize": 16,
        }
    )
    points = np.zeros(height * width, dtype)
    points["x"], points["ring"] = np.arange(height * width), 9
    points["rgb"] = [1, 2, 3]
    given = {"fields": fields, "point_step": 16, "row_step": 16 * width, "data": points.tobytes(), **changes}
    return PointCloud2(height=height, width=width, **given)


def test_a_point_cloud_is_a_structured_array() -> None:
    """Its fields by name, at their offsets; organised clouds have rows."""
    points = cloud().to_numpy()
    assert points.shape == (2,)
    assert points["x"].tolist() == [0.0, 1.0]
    assert points["rgb"].tolist() == [[1, 2, 3]] * 2
    assert points["ring"].tolist() == [9, 9]
    organised = cloud(2, 3).to_numpy()
    assert organised.shape == (2, 3)
    assert organised["x"][1].tolist() == [3.0, 4.0, 5.0]


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"point_step": 8}, "PointCloud2.fields"),
        ({"data": bytes(31)}, "PointCloud2.data: .* need 32 bytes, not 31"),
        ({"fields": [PointField(name="x", datatype=77, count=1)]}, "'x' has datatype 77, which does not exist"),
        ({"fields": [PointField(name="x", datatype=7, count=1)] * 2}, "PointCloud2.fields"),
    ],
)
def test_a_cloud_that_contradicts_itself_is_refused(changes: dict[str, Any], text: str) -> None:
    """Fields outside the point or twice, and too little data."""
    with pytest.raises(DecodeError, match=text):
        cloud(**changes).to_numpy()


def test_scans_and_maps() -> None:
    """Ranges are the array they are; a map has rows."""
    scan = LaserScan(ranges=[1.0, 2.0])
    assert scan.to_numpy() is scan.ranges
    grid = OccupancyGrid(info=MapMetaData(width=3, height=2), data=[0, 1, 2, 3, 4, -1])
    assert grid.to_numpy().tolist() == [[0, 1, 2], [3, 4, -1]]
    with pytest.raises(DecodeError, match=r"OccupancyGrid\.data"):
        OccupancyGrid(info=MapMetaData(width=3, height=3), data=[0] * 8).to_numpy()
