"""Images as colours: each encoding, and what cannot be shown."""

from __future__ import annotations

import io

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image as Picture

from graphflow.introspect.messages import images
from graphflow.introspect.messages.images import NotShown, pixels, shrunk, uncompressed
from graphflow.msgs.sensor_msgs.msg import CompressedImage, Image


def image(encoding: str, values: NDArray[np.generic], *, padding: int = 0) -> Image:
    height, width = values.shape[:2]
    rows = [row.tobytes() + b"\0" * padding for row in values]
    data = np.frombuffer(b"".join(rows), np.uint8)
    return Image(encoding=encoding, width=width, height=height, step=len(rows[0]), data=data)


RED_BLUE = [[(250, 0, 5), (0, 10, 240)]]


@pytest.mark.parametrize(
    ("encoding", "values"),
    [
        ("rgb8", np.array([[(250, 0, 5), (0, 10, 240)]], np.uint8)),
        ("bgr8", np.array([[(5, 0, 250), (240, 10, 0)]], np.uint8)),
        ("rgba8", np.array([[(250, 0, 5, 9), (0, 10, 240, 9)]], np.uint8)),
        ("bgra8", np.array([[(5, 0, 250, 9), (240, 10, 0, 9)]], np.uint8)),
        ("8UC3", np.array([[(5, 0, 250), (240, 10, 0)]], np.uint8)),
        ("rgb16", np.array([[(250, 0, 5), (0, 10, 240)]], np.uint16) * 256),
    ],
)
@pytest.mark.parametrize("padding", [0, 6])
def test_colours(encoding: str, values: NDArray[np.generic], padding: int) -> None:
    """Each encoding gives the same colours, whether or not its rows are padded."""
    assert pixels(image(encoding, values, padding=padding)).tolist() == [[list(rgb) for rgb in RED_BLUE[0]]]


def test_greys_and_depths() -> None:
    """Greys stay; depths are spread between the nearest and the farthest, and what is unknown is black."""
    assert pixels(image("mono8", np.array([[0, 128, 255]], np.uint8)))[0, :, 1].tolist() == [0, 128, 255]
    assert pixels(image("mono16", np.array([[1000, 3000, 2000, 0]], "<u2")))[0, :, 0].tolist() == [40, 255, 147, 0]
    depths = np.array([[1.0, np.nan, 3.0, np.inf]], "<f4")
    assert pixels(image("32FC1", depths))[0, :, 0].tolist() == [40, 0, 255, 0]
    assert not pixels(image("32FC1", np.full((1, 2), np.nan, "<f4"))).any()


def test_colour_filters_and_yuv() -> None:
    """Four pixels of a colour filter become one; of YUV the brightness is shown."""
    square = np.array([[200, 100], [50, 10]], np.uint8)
    assert pixels(image("bayer_rggb8", square)).tolist() == [[[200, 75, 10]]]
    assert pixels(image("bayer_bggr8", square)).tolist() == [[[10, 75, 200]]]
    pairs = np.array([[[7, 1], [9, 2]]], np.uint8)
    assert pixels(image("yuv422_yuy2", pairs))[0, :, 0].tolist() == [7, 9]
    assert pixels(image("uyvy", pairs))[0, :, 0].tolist() == [1, 2]


@pytest.mark.parametrize(
    ("message", "said"),
    [
        (Image(), "an image of 0 x 0 pixels"),
        (Image(encoding="jpeg2000", width=1, height=1), "the encoding 'jpeg2000' is unknown; known are rgb8"),
        (
            Image(encoding="rgb8", width=2, height=2, step=6, data=np.zeros(11, np.uint8)),
            "it has 11 bytes, in rows of 6",
        ),
        (Image(encoding="rgb8", width=2, height=1, step=2, data=np.zeros(99, np.uint8)), "in rows of 2, which is too"),
    ],
)
def test_what_is_not_shown(message: Image, said: str) -> None:
    """The error says why, before memory is taken."""
    with pytest.raises(NotShown, match=said):
        pixels(message)


def test_compressed(monkeypatch: pytest.MonkeyPatch) -> None:
    """PNG and JPEG are decoded; other data, and pictures that are too large, are refused."""
    file = io.BytesIO()
    Picture.fromarray(np.array(RED_BLUE, np.uint8)).save(file, "PNG")
    data = np.frombuffer(file.getvalue(), np.uint8)
    assert uncompressed(CompressedImage(format="png", data=data)).tolist() == [[list(rgb) for rgb in RED_BLUE[0]]]
    with pytest.raises(NotShown, match="its data is no JPEG or PNG image"):
        uncompressed(CompressedImage(data=np.zeros(10, np.uint8)))
    monkeypatch.setattr(images, "PIXELS_BOUND", 1)
    with pytest.raises(NotShown, match="an image of 2 x 1 pixels is too large"):
        uncompressed(CompressedImage(data=data))


def test_scaling() -> None:
    """The nearest pixels are taken, in both directions."""
    grey = np.arange(4, dtype=np.uint8).reshape(2, 2)
    colours = np.repeat(grey[:, :, None], 3, axis=2)
    assert shrunk(colours, 4, 2)[:, :, 0].tolist() == [[0, 0, 1, 1], [2, 2, 3, 3]]
    assert shrunk(colours, 1, 1)[:, :, 0].tolist() == [[3]]
