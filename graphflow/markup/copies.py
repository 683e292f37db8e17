"""Copies of files with their substitutions made, each in a folder named by a hash of its content."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from tempfile import NamedTemporaryFile

from graphflow.folders import state_root


def copy_of(content: str, name: str) -> Path:
    """Return a file with some content, which is the same file for the same content.

    Raises:
        OSError: The file cannot be written.
    """
    file = state_root() / "copies" / hashlib.sha256(content.encode()).hexdigest()[:16] / name
    if file.is_file():
        return file
    file.parent.mkdir(parents=True, exist_ok=True)
    with NamedTemporaryFile("w", encoding="utf-8", dir=file.parent, delete=False) as made:
        made.write(content)
    os.replace(made.name, file)  # atomic: another process may be writing the same content
    return file
