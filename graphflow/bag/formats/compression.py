"""Compression by rosbag2, besides that of MCAP chunks: of whole files or of each message.

Sizes given in the data are not trusted: memory and disk space are bounded during decompression.

Source: rosbag2_compression, `compression_mode` and `compression_format` of a bag's metadata; the frames of RFC 8878 and
of LZ4, which distinguish a compressed message from CDR, whose first byte is 0.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import weakref
from collections.abc import Callable, Collection, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, BinaryIO, Protocol

from graphflow.bag.contents import Contents, Record
from graphflow.errors import BagError

SUFFIXES = {".zstd": "zstd", ".zst": "zstd", ".lz4": "lz4"}
"""Formats by suffix of a file's name."""
MAGICS = {b"\x28\xb5\x2f\xfd": "zstd", b"\x04\x22\x4d\x18": "lz4"}
"""Formats by the first bytes of compressed data."""
_PIECE = 1 << 20
_SHARE = 0.5
"""Largest part of a disk's free space that a decompressed file may take."""


class Damaged(Exception):
    """The data cannot be decompressed."""


class File(Protocol):
    """One readable file of a bag."""

    path: Path

    @property
    def contents(self) -> Contents: ...

    def records(
        self, names: Collection[str] | None = None, start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Record]: ...


class PackedFile:
    """A file that is compressed as a whole. It is decompressed into a temporary file while it is read.

    Args:
        path: The file; its name ends with one of `SUFFIXES`.
        open_file: Opens the decompressed file.
        is_kept: Whether the decompressed file exists as long as this object, so that it is decompressed once.

    Raises:
        BagError: It cannot be decompressed, or is not a bag then.
    """

    def __init__(self, path: Path, open_file: Callable[[Path], File], *, is_kept: bool = False) -> None:
        self.path, self._open_file = path, open_file
        self._kept: File | None = None
        with ExitStack() as stack:
            file = stack.enter_context(_loose(path, open_file))
            self.contents = file.contents
            self.kind = type(file)
            if is_kept:
                self._kept = file
                weakref.finalize(self, stack.pop_all().close)

    def records(
        self, names: Collection[str] | None = None, start_ns: int = 0, end_ns: int | None = None
    ) -> Iterator[Record]:
        """Yield messages in the order of their times. Arguments and errors as for `McapFile.records`."""
        with _loose(self.path, self._open_file) if self._kept is None else _named(self.path, self._kept) as file:
            yield from file.records(names, start_ns, end_ns)


@contextmanager
def _loose(source: Path, open_file: Callable[[Path], File]) -> Iterator[File]:
    """Decompress a file for the duration of the block."""
    try:
        with tempfile.TemporaryDirectory(prefix="graphflow-bag-") as folder:
            path = Path(folder) / source.stem
            try:
                decompress(source, path)
                yield open_file(path)
            except BagError as error:
                raise BagError(str(error).replace(str(path), str(source))) from None
    except OSError as error:
        raise BagError(f"{source}: {error.strerror}: {error.filename or tempfile.gettempdir()}") from None


@contextmanager
def _named(source: Path, file: File) -> Iterator[File]:
    """Name the compressed file in errors about the decompressed one."""
    try:
        yield file
    except BagError as error:
        raise BagError(str(error).replace(str(file.path), str(source))) from None


def decompress(source: Path, target: Path) -> None:
    """Decompress a file into a new one.

    Raises:
        BagError: It is damaged, or would leave too little space on the disk.
        OSError: The source cannot be read, or the target cannot be written.
    """
    room = int(shutil.disk_usage(target.parent).free * _SHARE)
    with source.open("rb") as packed, target.open("xb") as loose:
        try:
            with _stream(SUFFIXES[source.suffix], packed) as stream:
                while piece := stream.read(_PIECE):
                    room -= len(piece)
                    if room < 0:
                        where = f"{target.parent.parent} has too little room to decompress it"
                        raise BagError(f"{source}: {where}; set TMPDIR to a folder on a larger disk")
                    loose.write(piece)
        except Damaged as error:
            raise BagError(f"{source}: {error}") from None
    if not os.path.getsize(target):
        raise BagError(f"{source}: it is empty")


def unpacked(form: str, data: bytes | memoryview, bound: int) -> bytes:
    """Decompress at most `bound` bytes, whatever size the data give, and one more if there are more.

    Raises:
        Damaged: The data are not compressed by `form`, or `form` is not known.
    """
    import zstandard

    try:
        if form == "zstd":
            found = zstandard.ZstdDecompressor().stream_reader(bytes(data)).read(bound + 1)
            size = zstandard.frame_content_size(data)  # negative if the frame does not give it
            if len(found) <= bound and (len(found) < size if size >= 0 else not _is_whole(data)):
                raise Damaged("it ends early")
            return found
        if form == "lz4":
            import lz4.frame

            decompressor = lz4.frame.LZ4FrameDecompressor()
            found = bytes(decompressor.decompress(bytes(data), max_length=bound + 1))
            if not decompressor.eof and len(found) <= bound:
                raise Damaged("it ends early")
            return found
    except (RuntimeError, MemoryError, zstandard.ZstdError) as error:
        raise Damaged(str(error)) from None
    raise Damaged(f"compressed by {form[:20]!r}, which is not known")


def _is_whole(data: bytes | memoryview) -> bool:
    """Return whether a Zstandard frame is complete, by decompressing it again: its size is known to be bounded."""
    import zstandard

    decompressor = zstandard.ZstdDecompressor().decompressobj()
    decompressor.decompress(bytes(data))
    return bool(decompressor.eof)


def loosened(records: Iterator[Record], path: Path, bound: int, *, is_packed: bool) -> Iterator[Record]:
    """Decompress the compressed messages of records.

    Args:
        is_packed: Whether all are compressed; else their first bytes decide.

    Raises:
        BagError: One cannot be decompressed.
    """
    for record in records:
        form = MAGICS.get(record.data[:4])
        is_frame = form is not None and (is_packed or record.topic.encoding == "cdr")
        if not is_frame and not is_packed:
            yield record
            continue
        try:
            yield record._replace(data=_message(form, record.data, bound))
        except Damaged as error:
            at = f"the message of {record.topic.name} at {record.log_ns} ns"
            raise BagError(f"{path}: {at} cannot be decompressed: {error}") from None


def _message(form: str | None, data: bytes, bound: int) -> bytes:
    if form is None:
        raise Damaged("it is compressed neither by zstd nor by lz4")
    found = unpacked(form, data, bound)
    if len(found) > bound:
        raise Damaged(f"it has more than {bound:,} bytes")
    return found


@contextmanager
def _stream(form: str, packed: BinaryIO) -> Iterator[Any]:
    """Open a decompressing stream over a file."""
    import zstandard

    try:
        if form == "zstd":
            with zstandard.ZstdDecompressor().stream_reader(packed, read_across_frames=True) as stream:
                yield stream
        else:
            import lz4.frame

            with lz4.frame.open(packed) as stream:
                yield stream
    except (RuntimeError, EOFError, zstandard.ZstdError) as error:
        raise Damaged(str(error)) from None
