"""Conversion between `sensor_msgs/Image` and NumPy arrays. OpenCV is needed only to convert colours and to compress."""

from __future__ import annotations

import re
import sys
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import CompressedImage, Image
from std_msgs.msg import Header

_KINDS = {"8U": "u1", "8S": "i1", "16U": "u2", "16S": "i2", "32S": "i4", "32F": "f4", "64F": "f8"}
"""OpenCV's type names and NumPy's."""
_COLOURS = {
    "mono8": ("8U", 1),
    "mono16": ("16U", 1),
    **{name + bits: (f"{bits}U", len(name)) for name in ("bgr", "rgb", "bgra", "rgba") for bits in ("8", "16")},
    **{f"bayer_{order}{bits}": (f"{bits}U", 1) for order in ("rggb", "bggr", "gbrg", "grbg") for bits in ("8", "16")},
    "yuv422": ("8U", 2),
    "yuv422_yuy2": ("8U", 2),
}
"""Colour encodings: the element type and the number of channels."""
_PLAIN = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)C([1-9]\d?)?")
_YUV = ("UYVY", "YUY2")
_FILE_ENDINGS = {"jpg": ".jpg", "jpeg": ".jpg", "png": ".png", "bmp": ".bmp", "tiff": ".tiff", "webp": ".webp"}


class CvBridgeError(TypeError):
    """An image does not match its encoding, or cannot be converted."""


class CvBridge:
    """Converter of images."""

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return the type and channels of an encoding, as ("uint8", 3). Raises CvBridgeError if it is unknown."""
        kind, channels = _parse(encoding)
        return np.dtype(_KINDS[kind]).name, channels

    def dtype_with_channels_to_cvtype2(self, dtype: Any, n_channels: int) -> str:
        """Return OpenCV's name of a type with channels, as 8UC3. Raises CvBridgeError if it has none."""
        code = np.dtype(dtype).str[1:]
        for name, known in _KINDS.items():
            if known == code:
                return f"{name}C{n_channels}"
        raise CvBridgeError(f"images cannot have elements of type {np.dtype(dtype)}")

    def imgmsg_to_cv2(self, img_msg: Image, desired_encoding: str = "passthrough") -> NDArray[Any]:
        """Convert an image message to an array.

        Args:
            desired_encoding: The encoding of the result; `passthrough` to leave it unchanged.

        Returns:
            Shape (height, width), or (height, width, channels). A view of the message's memory if nothing has to be
            converted.

        Raises:
            CvBridgeError: An encoding is unknown, the message has too few bytes, or OpenCV has no such conversion.
        """
        kind, channels = _parse(img_msg.encoding)
        dtype = np.dtype(_KINDS[kind]).newbyteorder(">" if img_msg.is_bigendian else "<")
        row = img_msg.width * channels * dtype.itemsize
        step = img_msg.step or row
        data = np.frombuffer(memoryview(img_msg.data), dtype=np.uint8)
        if step < row or len(data) < step * img_msg.height:
            size = f"{img_msg.width} x {img_msg.height} {img_msg.encoding}"
            raise CvBridgeError(f"an image of {size} has only {len(data)} bytes, in rows of {step}")
        rows = data[: step * img_msg.height].reshape(img_msg.height, step)[:, :row]
        shape = (img_msg.height, img_msg.width) + ((channels,) if channels > 1 else ())
        image = np.ascontiguousarray(rows).view(dtype).reshape(shape)
        if not dtype.isnative:
            image = image.astype(dtype.newbyteorder("="))
        return image if desired_encoding == "passthrough" else _converted(image, img_msg.encoding, desired_encoding)

    def cv2_to_imgmsg(self, cvim: NDArray[Any], encoding: str = "passthrough", header: Header | None = None) -> Image:
        """Convert an array to an image message.

        Args:
            cvim: Shape (height, width), or (height, width, channels).
            encoding: The encoding of the array; `passthrough` for OpenCV's name of its type.

        Raises:
            CvBridgeError: The encoding is unknown, or does not match the array's type.
        """
        if not isinstance(cvim, np.ndarray) or cvim.ndim not in (2, 3):
            raise TypeError("Your input type is not a numpy array of two or three dimensions")
        channels = 1 if cvim.ndim == 2 else cvim.shape[2]
        own = self.dtype_with_channels_to_cvtype2(cvim.dtype.newbyteorder("="), channels)
        if encoding == "passthrough":
            encoding = own
        else:
            kind, wanted = _parse(encoding)
            if f"{kind}C{wanted}" != own:
                raise CvBridgeError(f"encoding specified as {encoding}, but image has incompatible type {own}")
        native = np.ascontiguousarray(cvim.astype(cvim.dtype.newbyteorder("="), copy=False))
        out = Image(height=cvim.shape[0], width=cvim.shape[1], encoding=encoding)
        if header is not None:
            out.header = header
        out.is_bigendian = int(sys.byteorder == "big")
        out.step = native.nbytes // cvim.shape[0] if cvim.shape[0] else 0
        out.data = native.tobytes()
        return out

    def compressed_imgmsg_to_cv2(
        self, cmprs_img_msg: CompressedImage, desired_encoding: str = "passthrough"
    ) -> NDArray[Any]:
        """Convert a compressed image to an array, BGR or in `desired_encoding`. Raises CvBridgeError."""
        cv2 = _opencv("to read compressed images")
        data = np.frombuffer(memoryview(cmprs_img_msg.data), dtype=np.uint8)
        image = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if len(data) else None
        if image is None:
            raise CvBridgeError(f"OpenCV cannot decode the data; its format is {cmprs_img_msg.format!r}")
        found = self.dtype_with_channels_to_cvtype2(image.dtype, 1 if image.ndim == 2 else image.shape[2])
        named = {"8UC1": "mono8", "16UC1": "mono16", "8UC3": "bgr8", "16UC3": "bgr16", "8UC4": "bgra8"}
        known = named.get(found, found)
        return image if desired_encoding == "passthrough" else _converted(image, known, desired_encoding)

    def cv2_to_compressed_imgmsg(self, cvim: NDArray[Any], dst_format: str = "jpg") -> CompressedImage:
        """Compress an array.

        Args:
            dst_format: jpg, png, bmp, tiff or webp.

        Raises:
            CvBridgeError: OpenCV cannot compress it in this format.
        """
        ending = _FILE_ENDINGS.get(dst_format.lower())
        if ending is None:
            raise CvBridgeError(
                f"{dst_format!r} is not a supported image format; use one of {', '.join(_FILE_ENDINGS)}"
            )
        is_done, data = _opencv("to compress images").imencode(ending, cvim)
        if not is_done:
            raise CvBridgeError(f"OpenCV cannot write this array as {dst_format}")
        return CompressedImage(format=dst_format, data=np.asarray(data).tobytes())


def _parse(encoding: str) -> tuple[str, int]:
    """Return the type and the number of channels."""
    plain = _PLAIN.fullmatch(encoding)
    if plain is not None:
        return plain[1], int(plain[2] or 1)
    try:
        return _COLOURS[encoding]
    except KeyError:
        raise CvBridgeError(f"Unrecognized image encoding [{encoding}]") from None


def _converted(image: NDArray[Any], encoding: str, desired: str) -> NDArray[Any]:
    """Convert an image to another encoding: its colours, and its values, scaled between 8 and 16 bits."""
    kind, channels = _parse(desired)
    if encoding == desired:
        return image
    if encoding in _COLOURS and desired in _COLOURS:
        cv2 = _opencv("to change the colours of an image")
        change = f"COLOR_{_colour(encoding)}2{_colour(desired)}"
        if _colour(encoding) in _YUV:
            change = f"COLOR_YUV2{_colour(desired)}_{_colour(encoding)}"
        if _colour(encoding) != _colour(desired):
            if not hasattr(cv2, change):
                raise CvBridgeError(f"OpenCV has no conversion from {encoding} to {desired}")
            image = cv2.cvtColor(image, getattr(cv2, change))
        if image.dtype != np.dtype(_KINDS[kind]):
            image = (image // 257 if kind == "8U" else image.astype(np.uint16) * 257).astype(_KINDS[kind])
        return image
    if (1 if image.ndim == 2 else image.shape[2]) != channels:
        raise CvBridgeError(f"[{encoding}] has not as many channels as [{desired}]")
    return image.astype(_KINDS[kind], copy=False)


def _colour(encoding: str) -> str:
    """Return OpenCV's name of the channels."""
    name = re.sub(r"(8|16)$", "", encoding)
    if name.startswith("bayer_"):  # OpenCV names them by the second row and column
        return {"rggb": "BayerBG", "bggr": "BayerRG", "gbrg": "BayerGR", "grbg": "BayerGB"}[name[6:]]
    return {"mono": "GRAY", "yuv422": "UYVY", "yuv422_yuy2": "YUY2"}.get(name, name.upper())


def _opencv(what: str) -> ModuleType:
    try:
        import cv2
    except ModuleNotFoundError:
        raise CvBridgeError(f"OpenCV is needed {what}: pip install opencv-python-headless") from None
    return cv2  # type: ignore[no-any-return]
