"""Images of ROS as arrays of colours, for those who look at them.

Source: sensor_msgs/msg/Image, sensor_msgs/image_encodings.hpp.
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

    from graphflow.msgs.sensor_msgs.msg import CompressedImage, Image

Pixels: TypeAlias = NDArray[np.uint8]
"""Red, green and blue, of shape (height, width, 3)."""
PIXELS_BOUND = 64_000_000
"""The number of pixels of a compressed image, at most."""

_LAYOUTS = {
    "rgb8": ("u1", (0, 1, 2)),
    "bgr8": ("u1", (2, 1, 0)),
    "rgba8": ("u1", (0, 1, 2)),
    "bgra8": ("u1", (2, 1, 0)),
    "rgb16": ("u2", (0, 1, 2)),
    "bgr16": ("u2", (2, 1, 0)),
    "8UC3": ("u1", (2, 1, 0)),
    "8UC4": ("u1", (2, 1, 0)),
}
"""The type of a channel, and the channels of red, green and blue."""
_GREYS = {"mono8": "u1", "8UC1": "u1", "mono16": "u2", "16UC1": "u2", "32FC1": "f4"}
_BAYER = {"bayer_rggb8": (0, 3), "bayer_bggr8": (3, 0), "bayer_gbrg8": (2, 1), "bayer_grbg8": (1, 2)}
"""The places of red and blue in a square of four pixels."""
_YUV = {"yuv422": 1, "uyvy": 1, "yuv422_yuy2": 0, "yuyv": 0}
"""The place of the brightness in a pair of bytes."""


class NotShown(ValueError):
    """An image cannot be shown; the text says why."""


def pixels(image: Image) -> Pixels:
    """Convert an image to colours; depths and other values without limits are spread from black to white.

    Raises:
        NotShown: Its encoding is unknown, or it has less data than its size says.
    """
    name = image.encoding
    width, height = image.width, image.height
    if not width or not height:
        raise NotShown(f"an image of {width} x {height} pixels")
    if name in _LAYOUTS:
        kind, order = _LAYOUTS[name]
        rows = _rows(image, kind, 4 if name.endswith(("a8", "4")) else 3)
        return _as_bytes(rows[:, :, order])
    if name in _GREYS:
        grey = _rows(image, _GREYS[name], 1)[:, :, 0]
        return np.repeat((_spread(grey) if _GREYS[name] != "u1" else _as_bytes(grey))[:, :, None], 3, axis=2)
    if name in _BAYER:
        return _debayered(_rows(image, "u1", 1)[:, :, 0], *_BAYER[name])
    if name in _YUV:
        grey = _rows(image, "u1", 2)[:, :, _YUV[name]]
        return np.repeat(grey[:, :, None], 3, axis=2)
    raise NotShown(f"the encoding {name!r} is unknown; known are {', '.join([*_LAYOUTS, *_GREYS, *_BAYER, *_YUV])}")


def uncompressed(image: CompressedImage) -> Pixels:
    """Decode a JPEG or PNG image.

    Raises:
        NotShown: It is neither, or it is too large.
    """
    from PIL import Image as Picture
    from PIL import UnidentifiedImageError

    try:
        with Picture.open(io.BytesIO(bytes(image.data)), formats=("JPEG", "PNG")) as picture:
            if picture.width * picture.height > PIXELS_BOUND:
                raise NotShown(f"an image of {picture.width:,} x {picture.height:,} pixels is too large")
            return np.asarray(picture.convert("RGB"))
    except (UnidentifiedImageError, OSError, SyntaxError, Picture.DecompressionBombError) as error:
        raise NotShown(f"its data is no JPEG or PNG image: {error}") from None


def _rows(image: Image, kind: str, channels: int) -> NDArray[np.generic]:
    """Return the values of an image, of shape (height, width, channels)."""
    data = np.frombuffer(bytes(image.data), np.uint8)
    used = image.width * channels * np.dtype(kind).itemsize
    step = image.step or used
    if step < used or data.size < step * (image.height - 1) + used:
        size = f"{image.width} x {image.height} pixels of {image.encoding}"
        raise NotShown(f"it has {data.size:,} bytes, in rows of {step:,}, which is too little for {size}")
    padded = np.zeros(step * image.height, np.uint8)
    padded[: min(data.size, padded.size)] = data[: padded.size]
    lines = padded.reshape(image.height, step)[:, :used]
    order = ">" if image.is_bigendian else "<"
    return np.ascontiguousarray(lines).view(np.dtype(order + kind)).reshape(image.height, image.width, channels)


def _as_bytes(values: NDArray[np.generic]) -> Pixels:
    numbers: NDArray[np.uint16] = values.astype(np.uint16)
    shifted = numbers // np.uint16(256 if values.dtype.itemsize == 2 else 1)
    out: Pixels = shifted.astype(np.uint8)
    return out


def _spread(values: NDArray[np.generic]) -> Pixels:
    """Spread values from the least to the greatest; what is no number, or 0, is black."""
    numbers = values.astype(np.float64)
    known = np.isfinite(numbers) & (numbers != 0)
    if not known.any():
        return np.zeros(values.shape, np.uint8)
    low, high = numbers[known].min(), numbers[known].max()
    share = (numbers - low) / (high - low) if high > low else np.ones(values.shape)
    return np.where(known, 40 + 215 * np.where(known, share, 0.0), 0).astype(np.uint8)


def _debayered(values: NDArray[np.generic], red: int, blue: int) -> Pixels:
    """Join squares of four pixels of a colour filter to one colour each, at half the size."""
    height, width = (size // 2 * 2 for size in values.shape)
    squares = values[:height, :width].reshape(height // 2, 2, width // 2, 2).swapaxes(1, 2).reshape(height // 2, -1, 4)
    greens = [at for at in range(4) if at not in (red, blue)]
    green = squares[:, :, greens].astype(np.uint16).sum(axis=2) // 2
    return np.stack([squares[:, :, red], green, squares[:, :, blue]], axis=2).astype(np.uint8)


def picture(image: Pixels) -> Picture:
    """Return pixels as an image of Pillow."""
    from PIL.Image import fromarray

    return fromarray(image)


def shrunk(image: Pixels, width: int, height: int) -> Pixels:
    """Scale an image to a size by the nearest pixels: of shape (height, width, 3)."""
    rows = (np.arange(height) + 0.5) * image.shape[0] / height
    columns = (np.arange(width) + 0.5) * image.shape[1] / width
    out: Pixels = image[rows.astype(np.int64)[:, None], columns.astype(np.int64)[None, :]]
    return out
