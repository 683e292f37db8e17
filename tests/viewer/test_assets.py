"""Files for viewers: meshes of packages, and nothing else."""

from __future__ import annotations

import asyncio
import struct
from pathlib import Path

import pytest

from graphflow.errors import UsageFault
from graphflow.testing import Graph
from graphflow.viewer import assets
from graphflow.viewer.assets import asset
from tests.viewer.cast import Robot, served, viewer


@pytest.fixture
def here(tmp_path: Path) -> Path:
    package = tmp_path / "src" / "arm"
    (package / "meshes").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>arm</name></package>")
    (package / "meshes" / "a.stl").write_bytes(b"solid a")
    (package / "secret.txt").write_text("secret")
    (tmp_path / "outside.stl").write_bytes(b"outside")
    (package / "link.stl").symlink_to(tmp_path / "outside.stl")
    return tmp_path


def test_a_mesh(here: Path) -> None:
    """It is found in its package."""
    assert asset("package://arm/meshes/a.stl", here) == b"solid a"


@pytest.mark.parametrize(
    ("uri", "said"),
    [
        ("file:///etc/passwd", "only files of packages are served"),
        ("package://arm", "only files of packages are served"),
        ("package://arm/secret.txt", "only meshes and pictures are served"),
        ("package://arm/../../outside.stl", "the file is outside its package"),
        ("package://arm//etc/x.stl", "the file is outside its package"),
        ("package://arm/link.stl", "the file is outside its package"),
        ("package://nothing/a.stl", "there is no package 'nothing' here"),
        ("package://arm/meshes/b.stl", "No such file or directory"),
        ("package://a\x1b[31m/b.stl", "there is no package"),
    ],
)
def test_what_is_not_served(here: Path, uri: str, said: str) -> None:
    """Files elsewhere, of other kinds, and such as do not exist; nothing reaches a terminal as it is."""
    with pytest.raises(UsageFault) as caught:
        asset(uri, here)
    assert said in str(caught.value)
    assert "\x1b" not in str(caught.value)


def test_the_size_is_bounded(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file that is too large is refused."""
    monkeypatch.setattr(assets, "ASSET_BOUND", 3)
    with pytest.raises(UsageFault, match="it has more than 3 bytes"):
        asset("package://arm/meshes/a.stl", here)


@pytest.mark.usefixtures("graphflow_runner")
async def test_a_viewer_asks(graph: Graph, here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It gets the file, or the reason, with the number of its request; a read-only server serves files, too."""
    monkeypatch.chdir(here)
    async with served(graph, Robot(), is_read_only=True) as lab, viewer(lab.port) as seen:
        assert "assets" in seen.info["capabilities"]
        await seen.send("fetchAsset", uri="package://arm/meshes/a.stl", requestId=7)
        await seen.send("fetchAsset", uri="package://arm/no.stl", requestId=8)
        async with asyncio.timeout(10):
            await seen.until(lambda: len(seen.assets) == 2)
        assert seen.assets[7] == (0, "", b"solid a")
        status, text, data = seen.assets[8]
        assert (status, data) == (1, b"")
        assert "No such file" in text


def test_the_frame() -> None:
    """As the protocol has it: number, status, the error's length and text, the data."""
    from graphflow.viewer.protocol import asset_frame

    assert asset_frame(5, b"xy") == struct.pack("<BIBI", 4, 5, 0, 0) + b"xy"
    assert asset_frame(5, b"", "no") == struct.pack("<BIBI", 4, 5, 1, 2) + b"no"
