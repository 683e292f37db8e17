"""Images as arrays. OpenCV itself is not installed for the tests: a stand-in shows what is asked of it."""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from cv_bridge import CvBridge, CvBridgeError
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

bridge = CvBridge()


@pytest.mark.parametrize(
    ("dtype", "channels", "encoding"),
    [
        (np.uint8, 3, "bgr8"),
        (np.uint8, 1, "mono8"),
        (np.uint8, 4, "rgba8"),
        (np.uint16, 1, "mono16"),
        (np.uint16, 3, "rgb16"),
        (np.float32, 1, "32FC1"),
        (np.float64, 2, "64FC2"),
        (np.int16, 1, "16SC1"),
        (np.uint8, 1, "bayer_rggb8"),
    ],
)
def test_an_array_there_and_back(dtype: Any, channels: int, encoding: str) -> None:
    """With its type and its shape."""
    shape = (2, 5) if channels == 1 else (2, 5, channels)
    image = np.arange(np.prod(shape)).reshape(shape).astype(dtype)
    message = bridge.cv2_to_imgmsg(image, encoding, Header(frame_id="camera"))
    assert (message.height, message.width, message.encoding) == (2, 5, encoding)
    assert message.step == 5 * channels * image.itemsize
    assert message.header.frame_id == "camera"
    again = bridge.imgmsg_to_cv2(message)
    assert again.dtype == dtype
    assert again.tolist() == image.tolist()
    assert bridge.imgmsg_to_cv2(message, encoding).tolist() == image.tolist()
    assert bridge.encoding_to_dtype_with_channels(encoding) == (np.dtype(dtype).name, channels)


def test_without_an_encoding_it_is_opencvs_name_of_the_type() -> None:
    """Also of an array that is a part of another, or of the other order of bytes."""
    whole = np.arange(24, dtype=">u2").reshape(2, 4, 3)
    message = bridge.cv2_to_imgmsg(whole[:, ::2])
    assert (message.encoding, message.width) == ("16UC3", 2)
    assert bridge.imgmsg_to_cv2(message).tolist() == whole[:, ::2].tolist()


def test_images_of_others() -> None:
    """Rows may be filled up, and bytes stand the other way round."""
    message = Image(height=2, width=1, encoding="mono16", step=3, is_bigendian=1)
    message.data = b"\x01\x02?\x03\x04?"
    assert bridge.imgmsg_to_cv2(message).tolist() == [[0x0102], [0x0304]]
    assert bridge.imgmsg_to_cv2(message, "32FC1").dtype == np.float32


def test_what_does_not_fit_is_told() -> None:
    """An encoding, a type, too few bytes, too few channels."""
    image = np.zeros((2, 2, 3), np.uint8)
    with pytest.raises(CvBridgeError, match=r"Unrecognized image encoding \[bgr9\]"):
        bridge.cv2_to_imgmsg(image, "bgr9")
    with pytest.raises(CvBridgeError, match="specified as mono8, but image has incompatible type 8UC3"):
        bridge.cv2_to_imgmsg(image, "mono8")
    with pytest.raises(CvBridgeError, match="elements of type complex128"):
        bridge.cv2_to_imgmsg(image.astype(complex))
    with pytest.raises(TypeError, match="not a numpy array of two or three dimensions"):
        bridge.cv2_to_imgmsg([1, 2])  # type: ignore[arg-type]
    message = bridge.cv2_to_imgmsg(image)
    with pytest.raises(CvBridgeError, match="not as many channels"):
        bridge.imgmsg_to_cv2(message, "32FC1")
    message.height = 50_000
    with pytest.raises(CvBridgeError, match="2 x 50000 8UC3 has only 12 bytes"):
        bridge.imgmsg_to_cv2(message)


def test_colours_and_files_are_opencvs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Which is asked by its own names."""
    asked: list[Any] = []

    def convert(image: Any, code: str) -> Any:
        asked.append(code)
        return image

    names = ("BGR2RGB", "BGR2GRAY", "BayerBG2BGR", "YUV2BGR_UYVY")
    codes = {f"COLOR_{name}": name for name in names}
    cv2 = SimpleNamespace(
        cvtColor=convert,
        imencode=lambda ending, image: (ending != ".webp", np.frombuffer(ending.encode(), np.uint8)),
        imdecode=lambda data, flags: np.zeros((1, 1, 3), np.uint8) if bytes(data) == b".png" else None,
        IMREAD_UNCHANGED=-1,
        **codes,
    )
    monkeypatch.setitem(sys.modules, "cv2", cv2)
    image = bridge.cv2_to_imgmsg(np.full((1, 1, 3), 255, np.uint8), "bgr8")
    bridge.imgmsg_to_cv2(image, "rgb8")
    bayer = bridge.cv2_to_imgmsg(np.zeros((2, 2), np.uint8), "bayer_rggb8")
    bridge.imgmsg_to_cv2(bayer, "bgr8")
    bridge.imgmsg_to_cv2(bridge.cv2_to_imgmsg(np.zeros((2, 2, 2), np.uint8), "yuv422"), "bgr8")
    assert asked == ["BGR2RGB", "BayerBG2BGR", "YUV2BGR_UYVY"]
    assert bridge.imgmsg_to_cv2(image, "bgr16").tolist() == [[[65535] * 3]]
    with pytest.raises(CvBridgeError, match="no conversion from bgr8 to yuv422"):
        bridge.imgmsg_to_cv2(image, "yuv422")
    compressed = bridge.cv2_to_compressed_imgmsg(np.zeros((1, 1, 3), np.uint8), "png")
    assert (compressed.format, bytes(compressed.data)) == ("png", b".png")
    assert bridge.compressed_imgmsg_to_cv2(compressed, "bgr8").shape == (1, 1, 3)
    for unreadable in (b"", b"no image"):
        with pytest.raises(CvBridgeError, match="cannot decode"):
            bridge.compressed_imgmsg_to_cv2(CompressedImage(data=unreadable))
    with pytest.raises(CvBridgeError, match="'gif' is not a supported"):
        bridge.cv2_to_compressed_imgmsg(np.zeros((1, 1), np.uint8), "gif")
    with pytest.raises(CvBridgeError, match="cannot write this array as webp"):
        bridge.cv2_to_compressed_imgmsg(np.zeros((1, 1), np.uint8), "webp")


def test_without_opencv_it_is_said_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    """What needs none goes on working."""
    monkeypatch.setitem(sys.modules, "cv2", None)
    image = bridge.cv2_to_imgmsg(np.zeros((1, 1, 3), np.uint8), "bgr8")
    with pytest.raises(CvBridgeError, match="pip install opencv-python-headless"):
        bridge.imgmsg_to_cv2(image, "rgb8")
    assert bridge.imgmsg_to_cv2(image, "bgr8").shape == (1, 1, 3)
