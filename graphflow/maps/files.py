"""Map files: a picture (PGM or PNG) and a YAML file with its place, as ROS's map_server reads and writes them.

Source: the map_server of Navigation2, https://docs.nav2.org, and of ROS 1, http://wiki.ros.org/map_server.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, StrictStr, model_validator

from graphflow.errors import GraphFileError, MapFileError, Problem
from graphflow.maps.grid import CELLS_BOUND, FREE, OCCUPIED, UNKNOWN, GridMap
from graphflow.markup import source
from graphflow.markup.validated import validated
from graphflow.names import nearest
from graphflow.reading import why_no_file

FORMATS = ("pgm", "png")
_FREE_GREY, _OCCUPIED_GREY, _UNKNOWN_GREY = 254, 0, 205
"""The greys of written maps. With the thresholds below, an unknown cell is read as one."""
OCCUPIED_THRESHOLD, FREE_THRESHOLD = 0.65, 0.196
Share = Annotated[float, Field(ge=0.0, le=1.0)]


class MapDescription(BaseModel):
    """The YAML file of a map.

    Attributes:
        image: The path of the picture, from the file's folder.
        resolution: The size of a cell in metres.
        origin: The place of the lower left corner: x, y in metres, yaw in radians.
        negate: Whether light is occupied, instead of dark.
        occupied_thresh, free_thresh: Darkness, from 0 to 1, above which a cell is occupied, and below which it is free.
        mode: `trinary` for free, occupied and unknown; `scale` for probabilities between; `raw` for values as they are.
    """

    model_config = ConfigDict(extra="ignore", frozen=True)

    image: StrictStr
    resolution: Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
    origin: Annotated[list[Annotated[float, Field(allow_inf_nan=False)]], Field(min_length=3, max_length=3)]
    negate: bool = False
    occupied_thresh: Share = OCCUPIED_THRESHOLD
    free_thresh: Share = FREE_THRESHOLD
    mode: Literal["trinary", "scale", "raw"] = "trinary"

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.free_thresh >= self.occupied_thresh:
            raise ValueError(f"free_thresh {self.free_thresh} is not below occupied_thresh {self.occupied_thresh}")
        return self


def read_map(file: Path | str) -> GridMap:
    """Read a map by the path of its YAML file.

    Raises:
        GraphFileError: The file has mistakes; all of them, with their places.
        MapFileError: The picture is missing, is none, or is too large.
    """
    file = Path(file)
    src = source.read_file(file, str(file))
    about = validated(src, MapDescription)
    _refuse_slips(src)
    picture = file.parent / about.image
    try:
        grey, opacity = _read_picture(picture)
    except MapFileError as error:
        raise GraphFileError([Problem(src.place(("image",)), str(error))]) from None
    x, y, yaw = about.origin
    cells = _cells(grey, opacity, about)
    return GridMap(np.ascontiguousarray(cells[::-1]), about.resolution, (x, y, yaw))


def _refuse_slips(src: source.Source) -> None:
    """Refuse a key that is a misspelt one; other tools' keys are left out, as ROS does."""
    known = list(MapDescription.model_fields)
    keys = src.data if isinstance(src.data, dict) else {}
    slips = [(key, nearest(key, known)) for key in keys if key not in known]
    problems = [
        Problem(src.key_place((key,)), f"unknown key {key!r}; did you mean {near!r}?") for key, near in slips if near
    ]
    if problems:
        raise GraphFileError(problems)


def _read_picture(file: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Read a picture; returns greys and opacities from 0 to 255, of shape (height, width).

    Raises:
        MapFileError: It is missing, is none, or is too large.
    """
    from PIL import Image, UnidentifiedImageError

    if not file.is_file():
        raise MapFileError(why_no_file(file, f"there is no picture {file}"))
    try:
        with Image.open(file) as image:
            if image.width * image.height > CELLS_BOUND:
                size = f"{image.width:,} x {image.height:,}"
                raise MapFileError(f"{file} has {size} pixels; a map has at most {CELLS_BOUND:,} cells")
            # Like map_server, the mean of the colours, not their brightness to the eye.
            pixels = np.asarray(image.convert("RGBA"), dtype=np.float64)
    except (UnidentifiedImageError, OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise MapFileError(f"{file} is not a picture that can be read: {error}") from None
    return pixels[..., :3].mean(axis=2), pixels[..., 3]


def _cells(grey: NDArray[np.float64], opacity: NDArray[np.float64], about: MapDescription) -> NDArray[np.int8]:
    """Convert greys to values of cells, in the picture's order."""
    if about.mode == "raw":
        values = np.round(grey)
        return np.where(values <= OCCUPIED, values, UNKNOWN).astype(np.int8)
    dark = grey / 255.0 if about.negate else 1.0 - grey / 255.0
    if about.mode == "scale":
        share = (dark - about.free_thresh) / (about.occupied_thresh - about.free_thresh)
        between = np.round(share * (OCCUPIED - 2)) + 1
    else:
        between = np.full(grey.shape, float(UNKNOWN))
    between[dark > about.occupied_thresh] = OCCUPIED
    between[dark < about.free_thresh] = FREE
    if about.mode == "scale":
        between[opacity < 255] = UNKNOWN
    return between.astype(np.int8)


def write_map(
    grid: GridMap,
    file: Path | str,
    *,
    picture_format: str = "pgm",
    mode: str = "trinary",
    occupied: float = OCCUPIED_THRESHOLD,
    free: float = FREE_THRESHOLD,
) -> tuple[Path, Path]:
    """Write a map; returns the paths of its YAML file and of its picture.

    Args:
        file: The path, with or without `.yaml`; the picture is beside it.
        picture_format: One of `FORMATS`.
        mode: `trinary` or `raw`, which keeps every value.
        occupied, free: Probabilities from 0 to 1 from which, and up to which, a cell counts as occupied or free.

    Raises:
        MapFileError: It cannot be written; nothing is left behind.
    """
    from PIL import Image

    file = Path(file)
    base = file.with_suffix("") if file.suffix in (".yaml", ".yml", ".pgm", ".png") else file
    described, picture = base.with_name(f"{base.name}.yaml"), base.with_name(f"{base.name}.{picture_format}")
    values = grid.cells[::-1]
    if mode == "raw":
        grey = values.astype(np.uint8)  # -1 becomes 255
    else:
        grey = np.full(values.shape, _UNKNOWN_GREY, np.uint8)
        grey[values >= occupied * OCCUPIED] = _OCCUPIED_GREY
        grey[(values >= 0) & (values <= free * OCCUPIED)] = _FREE_GREY
    x, y, yaw = (_number(value) for value in grid.origin)
    text = (
        f"image: {picture.name}\nmode: {mode}\nresolution: {_number(grid.resolution)}\norigin: [{x}, {y}, {yaw}]\n"
        f"negate: 0\noccupied_thresh: {_number(occupied)}\nfree_thresh: {_number(free)}\n"
    )
    if not described.parent.is_dir():
        raise MapFileError(f"there is no folder {described.parent}")
    parts = [described.with_name(f".{described.name}.part"), picture.with_name(f".{picture.name}.part")]
    try:
        Image.fromarray(grey).save(parts[1], format={"pgm": "PPM", "png": "PNG"}[picture_format])
        parts[0].write_text(text)
        parts[1].replace(picture)
        parts[0].replace(described)
    except OSError as error:
        for part in parts:
            part.unlink(missing_ok=True)
        raise MapFileError(f"cannot write {error.filename or described}: {error.strerror or error}") from None
    return described, picture


def _number(value: float) -> str:
    """Return a number as YAML reads it back as a float."""
    short = f"{value:.6g}"
    return short if math.isclose(float(short), value, rel_tol=1e-6, abs_tol=1e-9) and "e" not in short else repr(value)
