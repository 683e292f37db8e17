"""Map files as ROS's map_server reads and writes them, and each mistake at its line."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from graphflow.errors import GraphFileError, MapFileError
from graphflow.maps import GridMap, files, read_map, write_map

GRID = GridMap(np.array([[0, 100, -1, 30], [70, 10, 0, 64]], np.int8), 0.05, (-1.25, 2.0, 0.0))


@pytest.mark.parametrize("picture_format", files.FORMATS)
def test_round_trip(tmp_path: Path, picture_format: str) -> None:
    """Free, occupied and unknown cells come back; what is between counts as unknown."""
    described, picture = write_map(GRID, tmp_path / "m.yaml", picture_format=picture_format)
    assert (described.name, picture.name) == ("m.yaml", f"m.{picture_format}")
    back = read_map(described)
    assert back.cells.tolist() == [[0, 100, -1, -1], [100, 0, 0, -1]]
    assert (back.resolution, back.origin) == (0.05, GRID.origin)
    assert not list(tmp_path.glob(".*"))


def test_raw_keeps_every_value(tmp_path: Path) -> None:
    """In the mode `raw`, probabilities are kept."""
    described, _ = write_map(GRID, tmp_path / "m", mode="raw")
    assert np.array_equal(read_map(described).cells, GRID.cells)


def test_the_file(tmp_path: Path) -> None:
    """The text is what ROS's map_saver writes; a picture's first row has the largest y."""
    described, picture = write_map(GRID, tmp_path / "m")
    assert described.read_text().splitlines() == [
        "image: m.pgm",
        "mode: trinary",
        "resolution: 0.05",
        "origin: [-1.25, 2, 0]",
        "negate: 0",
        "occupied_thresh: 0.65",
        "free_thresh: 0.196",
    ]
    assert picture.read_bytes().startswith(b"P5")
    with Image.open(picture) as image:
        assert np.asarray(image).tolist() == [[0, 254, 254, 205], [254, 0, 205, 205]]


def written(folder: Path, text: str, greys: list[list[int]]) -> Path:
    Image.fromarray(np.array(greys, np.uint8)).save(folder / "p.png")
    (folder / "m.yaml").write_text("image: p.png\nresolution: 0.1\norigin: [0, 0, 0]\n" + text)
    return folder / "m.yaml"


@pytest.mark.parametrize(
    ("text", "cells"),
    [
        ("", [100, -1, -1, 0]),
        ("free_thresh: 0.2", [100, -1, 0, 0]),
        ("negate: 1", [0, -1, 100, 100]),
        ("mode: scale\nfree_thresh: 0.1\noccupied_thresh: 0.9", [100, 50, 13, 0]),
        ("mode: raw", [0, -1, -1, -1]),
    ],
)
def test_modes(tmp_path: Path, text: str, cells: list[int]) -> None:
    """Greys become values as ROS's map_server documents them."""
    assert read_map(written(tmp_path, text, [[0, 127, 205, 254]])).cells.tolist() == [cells]


def test_colours_and_transparency(tmp_path: Path) -> None:
    """The mean of the colours counts; in the mode `scale`, transparent cells are unknown."""
    file = written(tmp_path, "mode: scale", [[0]])
    Image.fromarray(np.array([[[255, 0, 0, 255], [255, 255, 255, 0]]], np.uint8), "RGBA").save(tmp_path / "p.png")
    assert read_map(file).cells.tolist() == [[100, -1]]


MISTAKES = {
    "image: p.png\nresolution: 0.1\n": "m.yaml:1:1: the key 'origin' is missing",
    "image: p.png\nresolution: 0\norigin: [0, 0, 0]\n": "m.yaml:2:13: 0: input should be greater than 0",
    "image: p.png\nresolution: 0.1\norigin: [0, 0]\n": "m.yaml:3:9: [0, 0]: has 2 of at least 3 items",
    "image: p.png\nresolution: 0.1\norigin: [0, 0, .nan]\n": "m.yaml:3:16: nan: input should be a finite number",
    "image: q.png\nresolution: 0.1\norigin: [0, 0, 0]\n": "m.yaml:1:8: there is no picture ",
    "image: m.yaml\nresolution: 0.1\norigin: [0, 0, 0]\n": "m.yaml is not a picture that can be read",
    "image: p.png\nresolution: 0.1\norigin: [0, 0, 0]\nfree_tresh: 0.1\n": "4:1: unknown key 'free_tresh'; did",
    "image: p.png\nresolution: 0.1\norigin: [0, 0, 0]\nfree_thresh: 0.7\n": "free_thresh 0.7 is not below",
    "image: p.png\nresolution: 0.1\norigin: [0, 0, 0]\nmode: trinar\n": "m.yaml:4:7: 'trinar': input should be",
    "image: [p.png\n": "m.yaml:1:14: not valid YAML",
    "- a\n": "m.yaml:1:1: ['a']",
}


@pytest.mark.parametrize("text", MISTAKES)
def test_mistakes(tmp_path: Path, text: str) -> None:
    """The error has the place, and what is right; keys of other tools are left out."""
    file = written(tmp_path, "", [[0]])
    assert read_map(file).cells.shape == (1, 1)
    file.write_text(text)
    with pytest.raises(GraphFileError) as caught:
        read_map(file)
    assert MISTAKES[text] in str(caught.value)


def test_keys_of_other_tools(tmp_path: Path) -> None:
    """They are left out, as ROS does."""
    assert read_map(written(tmp_path, "author: me\n", [[0]])).cells.shape == (1, 1)


def test_the_size_of_a_picture_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is refused before its pixels are read."""
    monkeypatch.setattr(files, "CELLS_BOUND", 3)
    with pytest.raises(GraphFileError, match="2 x 2 pixels; a map has at most 3 cells"):
        read_map(written(tmp_path, "", [[0, 0], [0, 0]]))


def test_what_cannot_be_written(tmp_path: Path) -> None:
    """The error says why, and nothing is left behind."""
    (tmp_path / "m.pgm").mkdir()
    with pytest.raises(MapFileError, match="cannot write"):
        write_map(GRID, tmp_path / "m")
    assert [file.name for file in tmp_path.iterdir()] == ["m.pgm"]
    with pytest.raises(MapFileError, match="there is no folder"):
        write_map(GRID, tmp_path / "nowhere" / "m")


def test_files_that_are_not_there(tmp_path: Path) -> None:
    """A similar name is suggested; a map is not written into a folder that does not exist."""
    (tmp_path / "house.yaml").write_text("")
    with pytest.raises(GraphFileError, match=r"No such file or directory; did you mean 'house.yaml'\?"):
        read_map(tmp_path / "hous.yaml")
    with pytest.raises(MapFileError, match=rf"^there is no folder {tmp_path}/plans$"):
        write_map(GRID, tmp_path / "plans" / "house")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no FIFOs")
def test_a_picture_that_is_no_file(tmp_path: Path) -> None:
    """It is there, and would never end."""
    os.mkfifo(tmp_path / "pipe.png")
    file = written(tmp_path, "", [[0]])
    file.write_text(file.read_text().replace("p.png", "pipe.png"))
    with pytest.raises(GraphFileError, match=r"m\.yaml:1:8: it is not a regular file"):
        read_map(file)


@pytest.mark.parametrize(
    ("resolution", "text"), [(5.0, "0.05 for 5 cm"), (1.0, "0.01 for 1 cm"), (0.5, ""), (0.05, "")]
)
def test_large_cells(resolution: float, text: str) -> None:
    """A resolution in centimetres is doubted."""
    grid = GridMap(GRID.cells, resolution, GRID.origin)
    remark = f"cells of {resolution:g} m are large: resolution: is in metres, {text}"
    assert grid.remark == (remark if text else "")
