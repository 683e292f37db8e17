"""The reader of bags: of folders, as from `ros2 bag record` or of ROS 1's `.bag` files, and of single files."""

from __future__ import annotations

import heapq
import re
from collections.abc import Collection, Iterator
from itertools import chain
from pathlib import Path

from graphflow.bag.contents import Record, together
from graphflow.bag.formats import metadata
from graphflow.bag.formats.compression import MAGICS, SUFFIXES, File, PackedFile, loosened
from graphflow.bag.formats.db3_file import Db3File
from graphflow.bag.formats.mcap_file import RECORD_BOUND, McapFile
from graphflow.bag.formats.metadata import FileContents
from graphflow.bag.formats.ros1_file import Ros1File
from graphflow.bag.nearby import suggestion
from graphflow.errors import BagError
from graphflow.reading import why_no_file

_FILES_BOUND = 10_000


class Bag:
    """A bag to read.

    Args:
        path: A folder, or a file.

    Raises:
        BagError: There is no bag, or it cannot be read.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        entries = metadata.read(self.path) if self.path.is_dir() else {}
        self.distro = _text(entries.get("ros_distro"))
        mode, form = _text(entries.get("compression_mode")).lower(), _text(entries.get("compression_format"))
        if mode in ("file", "message") and form not in MAGICS.values():
            raise BagError(f"{self.path}: it is compressed by {form!r}; graphflow reads {', '.join(MAGICS.values())}")
        self._is_packed = mode == "message"
        self._may_be_packed = self._is_packed or not entries
        paths = self._paths(entries)
        # All of several files decompressed at once could fill the disk.
        self.files: list[File] = [_file(file, is_kept=len(paths) == 1) for file in paths]
        self.contents = together([file.contents for file in self.files])

    @property
    def storage(self) -> str:
        """`mcap`, `sqlite3` or `rosbag_v2`, rosbag2's name for ROS 1's format."""
        kinds = {file.kind if isinstance(file, PackedFile) else type(file) for file in self.files}
        return "sqlite3" if Db3File in kinds else "rosbag_v2" if Ros1File in kinds else "mcap"

    @property
    def size(self) -> int:
        """The size of all files in bytes."""
        return sum(file.path.stat().st_size for file in self.files)

    @property
    def parts(self) -> list[FileContents]:
        """The contents of each file."""
        return [FileContents(file.path.name, file.contents) for file in self.files]

    def records(
        self, names: Collection[str] | None = None, start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Record]:
        """Yield messages in the order of their times.

        Args:
            names: Topics; None for all.
            start_ns: Earliest time, nanoseconds since 1970.
            end_ns: Time before which messages are read.

        Raises:
            BagError: A file is damaged.
        """
        found = self._records(names, start_ns, end_ns)
        if self._may_be_packed:
            found = loosened(found, self.path, RECORD_BOUND, is_packed=self._is_packed)
        return found

    def _records(self, names: Collection[str] | None, start_ns: int, end_ns: int | None) -> Iterator[Record]:
        wanted = [f for f in self.files if f.contents.message_count and f.contents.end_ns >= start_ns]
        together: list[File] = []
        until_ns = 0
        for file in sorted(wanted, key=lambda file: file.contents.start_ns):
            if together and file.contents.start_ns > until_ns:  # so that few files are open at once
                yield from _merged(together, names, start_ns, end_ns)
                together = []
            together.append(file)
            until_ns = max(until_ns, file.contents.end_ns)
        yield from _merged(together, names, start_ns, end_ns)

    def _paths(self, entries: dict[str, object]) -> list[Path]:
        if self.path.name == metadata.FILE:
            raise BagError(f"{self.path} is a part of the bag; give its folder: {self.path.parent}")
        if self.path.is_file():
            return [self.path]
        if not self.path.is_dir():
            why = why_no_file(self.path, f"there is no such file or folder{suggestion(self.path)}")
            raise BagError(f"{self.path}: {why}")
        named = entries.get("relative_file_paths")
        names = [Path(_text(name)).name for name in named[:_FILES_BOUND]] if isinstance(named, list) else []
        found = [self.path / name for name in names if name and (self.path / name).is_file()]
        # Files that a killed recorder wrote last are missing in the metadata. Of a file that exists twice, as after
        # rosbag2 has decompressed it, use the one in the metadata, else the one that is not compressed.
        have = {_loose(path) for path in found}
        there = sorted(self.path.iterdir(), key=lambda path: (path.suffix in SUFFIXES, _natural(path)))
        for path in there:
            if _loose(path).suffix in (".mcap", ".db3") and path.is_file() and _loose(path) not in have:
                found.append(path)
                have.add(_loose(path))
        found = found or [path for path in there if _is_ros1(path) and path.is_file()]
        if not found:
            missing = f"; its {metadata.FILE} names {', '.join(names)}" if names else ""
            raise BagError(f"{self.path}: it has no .mcap, .db3 or .bag file{missing}")
        return found


def _merged(files: list[File], names: Collection[str] | None, start_ns: int, end_ns: int | None) -> Iterator[Record]:
    """Merge the messages of files that overlap in time."""
    parts = [file.records(names, start_ns, end_ns) for file in files]
    return heapq.merge(*parts, key=lambda record: record.log_ns) if len(parts) > 1 else chain(*parts)


def _file(path: Path, *, is_kept: bool = False) -> File:
    if path.suffix in SUFFIXES:
        return PackedFile(path, _file, is_kept=is_kept)
    if _is_ros1(path):
        return Ros1File(path)
    return Db3File(path) if path.suffix == ".db3" else McapFile(path)


def _is_ros1(path: Path) -> bool:
    """Return whether a file is named as ROS 1 names its bags, also during recording."""
    return path.name.endswith((".bag", ".bag.active"))


def _loose(path: Path) -> Path:
    """Return the name of a file once it is decompressed."""
    return path.with_suffix("") if path.suffix in SUFFIXES else path


def _text(value: object) -> str:
    """Return a text of the metadata; empty for anything else."""
    return value[:300] if isinstance(value, str) else ""


def _natural(path: Path) -> list[object]:
    """Return a key that sorts `x_10` after `x_9`."""
    return [int(part) if part.isdecimal() else part for part in re.split(r"(\d+)", path.name)]
