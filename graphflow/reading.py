"""Files of others, found or named: nobody knows what they are, so only regular ones are read, up to a size.

A FIFO or a device that is called `package.xml` would keep whoever opens it waiting, and some files have no end.
"""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

FOUND_BOUND = 10_000_000
"""Bytes that a file may have: sources, definitions and manifests have far less."""


def found_bytes(path: Path, bound: int = FOUND_BOUND) -> bytes:
    """The content of a file; never waits.

    Raises:
        OSError: It cannot be read, is no regular file, or has more than `bound` bytes.
    """
    _refuse_others(os.stat(path), path)  # first: opening a device can do something
    with open(path, "rb", opener=_open_at_once) as file:
        about = os.fstat(file.fileno())
        _refuse_others(about, path)
        data = file.read(min(about.st_size, bound) + 1) or b""
        while len(data) <= bound and (more := file.read(1 << 16)):  # it grows, or does not say how long it is
            data += more
    if len(data) > bound:
        raise OSError(errno.EFBIG, f"it has more than {bound:,} bytes", str(path))
    return data


def found_text(path: Path, errors: str = "strict", bound: int = FOUND_BOUND) -> str:
    """The content of a file in UTF-8, with the ends of lines as Python has them. Arguments and errors as for `open`.

    Raises:
        OSError: As for `found_bytes`.
        UnicodeDecodeError: It is no text.
    """
    return found_bytes(path, bound).decode(errors=errors).replace("\r\n", "\n").replace("\r", "\n")


def _open_at_once(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _refuse_others(about: os.stat_result, path: Path) -> None:
    if stat.S_ISDIR(about.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(about.st_mode):
        raise OSError(errno.EINVAL, "it is not a regular file", str(path))
