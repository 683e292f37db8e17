"""Bags that rosbag2 has compressed, as files and message by message; and what only looks like one."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import lz4.frame
import pytest
import yaml
import zstandard
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as RosbagsWriter
from rosbags.typesys import Stores, get_typestore

from graphflow.bag.formats import compression
from graphflow.bag.reader import Bag
from graphflow.errors import BagError
from tests.bag.cast import CHATTER, START, record, some_records, write

PACK = {"zstd": zstandard.compress, "lz4": lz4.frame.compress}
EXPECTED = [(r.log_ns, r.data) for r in some_records() if r.topic == CHATTER]
SUFFIX = {StoragePlugin.MCAP: ".mcap", StoragePlugin.SQLITE3: ".db3"}


def foreign(folder: Path, plugin: StoragePlugin, mode: CompressionMode = CompressionMode.NONE) -> Path:
    """A bag that `rosbags` has written."""
    writer = RosbagsWriter(folder, version=9, storage_plugin=plugin)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        store = get_typestore(Stores.ROS2_JAZZY)
        connection = writer.add_connection(CHATTER.name, CHATTER.type, typestore=store)
        for when, data in EXPECTED:
            writer.write(connection, when, data)
    return folder


def said(folder: Path, **words: Any) -> None:
    """Change the metadata of a bag."""
    path = folder / "metadata.yaml"
    data = yaml.safe_load(path.read_text())
    data["rosbag2_bagfile_information"].update(words)
    path.write_text(yaml.safe_dump(data))


def read(path: Path) -> list[tuple[int, bytes]]:
    return [(r.log_ns, r.data) for r in Bag(path).records(["/chatter"])]


@pytest.mark.parametrize("mode", [CompressionMode.FILE, CompressionMode.MESSAGE])
@pytest.mark.parametrize("plugin", SUFFIX)
def test_a_bag_of_rosbags(tmp_path: Path, plugin: StoragePlugin, mode: CompressionMode) -> None:
    """By the folder, with its metadata and without, and by the file alone; nothing stays behind."""
    folder = foreign(tmp_path / "bag", plugin, mode)
    [file] = [path for path in folder.iterdir() if path.suffix != ".yaml"]
    assert file.suffix == (".zstd" if mode is CompressionMode.FILE else SUFFIX[plugin])
    assert read(folder) == read(file) == EXPECTED
    assert Bag(folder).storage == plugin.name.lower()
    (folder / "metadata.yaml").unlink()
    assert read(folder) == EXPECTED
    assert not list(Path(tempfile.gettempdir()).glob("graphflow-bag-*"))


@pytest.mark.parametrize("form", PACK)
def test_formats_of_files(tmp_path: Path, form: str) -> None:
    """Zstandard and LZ4, several files, each decompressed for itself."""
    folder = write(tmp_path / "bag", max_seconds=0.5)
    names = []
    for file in sorted(folder.glob("*.mcap")):
        packed = file.with_name(f"{file.name}.{form}")
        packed.write_bytes(PACK[form](file.read_bytes()))
        file.unlink()
        names.append(packed.name)
    said(folder, compression_mode="FILE", compression_format=form, relative_file_paths=names)
    assert len(names) > 3
    assert read(folder) == EXPECTED


@pytest.mark.parametrize(("count", "times"), [(1, 1), (2, 4)])
def test_a_single_file_is_decompressed_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, count: int, times: int
) -> None:
    """For contents and messages; of several, each is decompressed when it is read. Nothing of it stays."""
    folder = write(tmp_path / "bag")
    file = folder / "bag_0.mcap"
    for number in range(count):
        (folder / f"bag_{number}.mcap.zstd").write_bytes(zstandard.compress(file.read_bytes()))
    file.unlink()
    (folder / "metadata.yaml").unlink()
    done: list[Path] = []
    decompress = compression.decompress

    def counted(source: Path, target: Path) -> None:
        done.append(target)
        decompress(source, target)

    monkeypatch.setattr(compression, "decompress", counted)
    bag = Bag(folder)
    assert sum(1 for _ in bag.records()) == count * len(some_records())
    assert len(done) == times
    del bag
    assert not any(target.parent.exists() for target in done)


@pytest.mark.parametrize("form", PACK)
def test_formats_of_messages(tmp_path: Path, form: str) -> None:
    """Zstandard and LZ4."""
    folder = write(tmp_path / "bag", [r._replace(data=PACK[form](r.data)) for r in some_records()])
    said(folder, compression_mode="MESSAGE", compression_format=form)
    assert read(folder) == read(folder / "bag_0.mcap") == EXPECTED


@pytest.mark.parametrize("mode", ["NONE", "none", ""])
def test_a_bag_that_is_said_not_to_be_compressed(tmp_path: Path, mode: str) -> None:
    """Is read as it is, whatever its messages begin with."""
    folder = write(tmp_path / "bag", [record(CHATTER, zstandard.compress(b"x"), 0.0)])
    said(folder, compression_mode=mode)
    assert read(folder) == [(START, zstandard.compress(b"x"))]


@pytest.mark.parametrize("mode", ["FILE", "MESSAGE"])
def test_a_format_that_is_not_known(tmp_path: Path, mode: str) -> None:
    """Is told with those that are."""
    folder = write(tmp_path / "bag")
    said(folder, compression_mode=mode, compression_format="fake_comp")
    with pytest.raises(BagError, match="it is compressed by 'fake_comp'; graphflow reads zstd, lz4"):
        Bag(folder)


def test_a_file_that_is_there_twice(tmp_path: Path) -> None:
    """Is read once: rosbag2 leaves what it has decompressed beside the rest."""
    folder = foreign(tmp_path / "bag", StoragePlugin.MCAP, CompressionMode.FILE)
    loose = folder / "bag.mcap"
    compression.decompress(folder / "bag.mcap.zstd", loose)
    assert read(folder) == EXPECTED
    loose.write_bytes(b"")
    assert read(folder) == EXPECTED


@pytest.mark.parametrize("form", PACK)
def test_damaged_files(tmp_path: Path, form: str) -> None:
    """Each by its name, not by that of the temporary file; what the beginning of a file holds is read."""
    plain = (write(tmp_path / "bag", compression="none") / "bag_0.mcap").read_bytes()
    packed = PACK[form](plain)
    for data in (b"nonsense", packed[:10] + b"nonsense" + packed[18:], PACK[form](b"nonsense")):
        path = tmp_path / f"a.mcap.{form}"
        path.write_bytes(data)
        with pytest.raises(BagError) as caught:
            list(Bag(path).records())
        assert str(caught.value).startswith(f"{path}: ")
        assert "graphflow-bag-" not in str(caught.value)


@pytest.mark.parametrize("form", PACK)
def test_damaged_messages(tmp_path: Path, form: str) -> None:
    """Are told with their topic and time."""
    packed = PACK[form](b"\0\1\0\0" + bytes(100))
    for data, message in (
        (packed[:-4], "cannot be decompressed"),
        (b"\0\1\0\0", "it is compressed neither by zstd nor by lz4"),
        (b"", "it is compressed neither by zstd nor by lz4"),
    ):
        folder = write(tmp_path / f"bag{len(data)}", [record(CHATTER, data, 0.0)])
        said(folder, compression_mode="MESSAGE", compression_format=form)
        with pytest.raises(BagError, match=f"the message of /chatter at {START} ns .*{message}"):
            list(Bag(folder).records())


@pytest.mark.parametrize("form", PACK)
def test_bombs(tmp_path: Path, form: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A message of more than the bound, and a file of more than half the disk has left, are refused."""
    bomb = PACK[form](bytes(10_000))
    monkeypatch.setattr("graphflow.bag.reader.RECORD_BOUND", 9_999)
    folder = write(tmp_path / "bag", [record(CHATTER, bomb, 0.0)])
    said(folder, compression_mode="MESSAGE", compression_format=form)
    with pytest.raises(BagError, match="it has more than 9,999 bytes"):
        list(Bag(folder).records())
    path = tmp_path / f"a.mcap.{form}"
    path.write_bytes(bomb)
    monkeypatch.setattr("graphflow.bag.formats.compression._SHARE", 0.0)
    with pytest.raises(BagError, match=r"a\.mcap\.\w+: .* too little room to decompress it; set TMPDIR"):
        Bag(path)


def test_a_message_cut_short() -> None:
    """It is noticed, also where the frame does not name its size."""
    for names_size in (True, False):
        packer = zstandard.ZstdCompressor(write_content_size=names_size).compressobj(10_000 if names_size else -1)
        data = packer.compress(bytes(range(250)) * 40) + packer.flush()
        assert compression.unpacked("zstd", data, 10_000) == bytes(range(250)) * 40
        with pytest.raises(compression.Damaged, match="it ends early"):
            compression.unpacked("zstd", data[:-10], 10_000)
