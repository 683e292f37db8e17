"""A bag, read: a folder as `ros2 bag record` makes it or of ROS 1's `.bag` files, or a single file of such a format."""

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
from graphflow.bag.nearby import meant
from graphflow.errors import BagError

_FILES_BOUND = 10_000


class Bag:
    """Reads a bag.

    Args:
        path: A folder, or a file.

    Raises:
        BagError: There is none, or it cannot be read.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        said = metadata.read(self.path) if self.path.is_dir() else {}
        self.distro = _word(said.get("ros_distro"))
        mode, form = _word(said.get("compression_mode")).lower(), _word(said.get("compression_format"))
        if mode in ("file", "message") and form not in MAGICS.values():
            raise BagError(f"{self.path}: it is compressed by {form!r}; graphflow reads {', '.join(MAGICS.values())}")
        self._is_packed = mode == "message"
        self._may_be_packed = self._is_packed or not said
        paths = self._paths(said)
        # Of several, all decompressed at once could fill the disk.
        self.files: list[File] = [_file(file, is_kept=len(paths) == 1) for file in paths]
        self.contents = together([file.contents for file in self.files])

    @property
    def storage(self) -> str:
        """`mcap`, `sqlite3` or `rosbag_v2`, as rosbag2 calls ROS 1's."""
        kinds = {file.kind if isinstance(file, PackedFile) else type(file) for file in self.files}
        return "sqlite3" if Db3File in kinds else "rosbag_v2" if Ros1File in kinds else "mcap"

    @property
    def size(self) -> int:
        """Bytes of all files."""
        return sum(file.path.stat().st_size for file in self.files)

    @property
    def parts(self) -> list[FileContents]:
        """What is in each file."""
        return [FileContents(file.path.name, file.contents) for file in self.files]

    def records(
        self, names: Collection[str] | None = None, start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Record]:
        """Messages in the order of their times.

        Args:
            names: Topics; None for all.
            start_ns: From this time on, nanoseconds since 1970.
            end_ns: Up to this time, which does not belong to it.

        Raises:
            BagError: What is in a file cannot be read.
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
            if together and file.contents.start_ns > until_ns:  # so that few are open at once
                yield from _merged(together, names, start_ns, end_ns)
                together = []
            together.append(file)
            until_ns = max(until_ns, file.contents.end_ns)
        yield from _merged(together, names, start_ns, end_ns)

    def _paths(self, said: dict[str, object]) -> list[Path]:
        if self.path.name == metadata.FILE:
            raise BagError(f"{self.path} is a part of the bag; give its folder: {self.path.parent}")
        if self.path.is_file():
            return [self.path]
        if not self.path.is_dir():
            raise BagError(f"{self.path}: there is no such file or folder{meant(self.path)}")
        named = said.get("relative_file_paths")
        names = [Path(_word(name)).name for name in named[:_FILES_BOUND]] if isinstance(named, list) else []
        found = [self.path / name for name in names if name and (self.path / name).is_file()]
        # What a recorder that was killed wrote last is in no metadata. Of a file that is there twice, decompressed by
        # rosbag2 for example, the one counts that the metadata names, else the one that is not compressed.
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
    """The messages of files that overlap in time."""
    parts = [file.records(names, start_ns, end_ns) for file in files]
    return heapq.merge(*parts, key=lambda record: record.log_ns) if len(parts) > 1 else chain(*parts)


def _file(path: Path, *, is_kept: bool = False) -> File:
    if path.suffix in SUFFIXES:
        return PackedFile(path, _file, is_kept=is_kept)
    if _is_ros1(path):
        return Ros1File(path)
    return Db3File(path) if path.suffix == ".db3" else McapFile(path)


def _is_ros1(path: Path) -> bool:
    """Whether a file is called as ROS 1 calls its bags, also while they are recorded."""
    return path.name.endswith((".bag", ".bag.active"))


def _loose(path: Path) -> Path:
    """The name of a file once it is decompressed."""
    return path.with_suffix("") if path.suffix in SUFFIXES else path


def _word(said: object) -> str:
    """A word of the metadata; empty for anything else."""
    return said[:300] if isinstance(said, str) else ""


def _natural(path: Path) -> list[object]:
    """A key that sorts `x_10` after `x_9`."""
    return [int(part) if part.isdecimal() else part for part in re.split(r"(\d+)", path.name)]
