"""Safe reading of files of unknown kind: only regular files, up to a size.

Opening a FIFO or a device that is called `package.xml` could block, and some files have no end. Also safe parsing of
Python sources, in any thread.
"""

from __future__ import annotations

import ast
import errno
import os
import stat
from pathlib import Path

FOUND_BOUND = 10_000_000
"""Size limit in bytes: sources, definitions and manifests are far smaller."""
ATTEMPTS = 5
"""Times that a source is parsed before it is given up."""


def found_bytes(path: Path, bound: int = FOUND_BOUND) -> bytes:
    """Read a file without ever blocking.

    Raises:
        OSError: The file cannot be read, is not regular, or has more than `bound` bytes.
    """
    _refuse_others(os.stat(path), path)  # before opening: opening a device may have effects
    with open(path, "rb", opener=_open_at_once) as file:
        about = os.fstat(file.fileno())
        _refuse_others(about, path)
        data = file.read(min(about.st_size, bound) + 1) or b""
        while len(data) <= bound and (more := file.read(1 << 16)):  # the file grows, or reports no size, as in /proc
            data += more
    if len(data) > bound:
        raise OSError(errno.EFBIG, f"it has more than {bound:,} bytes", str(path))
    return data


def found_text(path: Path, errors: str = "strict", bound: int = FOUND_BOUND) -> str:
    """Read a file as UTF-8, with or without a byte order mark, with all line breaks as line feeds.

    Args:
        errors: As for `open`.

    Raises:
        OSError: As for `found_bytes`.
        UnicodeDecodeError: The file is not UTF-8.
    """
    return found_bytes(path, bound).decode("utf-8-sig", errors).replace("\r\n", "\n").replace("\r", "\n")


def lenient_text(path: Path, bound: int = FOUND_BOUND) -> str:
    """Return the text of a file that may be anything; "" if it cannot be read. Bytes that are no UTF-8 are replaced."""
    try:
        return found_text(path, "replace", bound)
    except OSError:
        return ""


def why_no_file(path: Path, absent: str = "there is no such file") -> str:
    """Return why a path is not read as a file: it is a FIFO, a socket or a device, or, as `absent` says, not there."""
    return "it is not a regular file" if path.exists() and not path.is_dir() else absent


def parsed(text: str) -> ast.Module:
    """Parse a source in any thread.

    Raises:
        SyntaxError, ValueError: It cannot be parsed.
    """
    # Python 3.11's parser keeps one counter for all threads, and may fail if two of them parse at once (gh-106905).
    for _ in range(ATTEMPTS):
        try:
            return ast.parse(text)
        except SystemError as error:
            reason = error
    raise ValueError(f"other threads keep Python's parser busy: {reason}")


def _open_at_once(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _refuse_others(about: os.stat_result, path: Path) -> None:
    if stat.S_ISDIR(about.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(about.st_mode):
        raise OSError(errno.EINVAL, "it is not a regular file", str(path))
