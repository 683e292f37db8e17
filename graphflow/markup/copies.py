"""Copies of files in which substitutions have been made, each in a folder that is named by what it holds."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from tempfile import NamedTemporaryFile

from graphflow.folders import state_root


def copy_of(content: str, name: str) -> Path:
    """A file with some content; always the same one for the same content.

    Raises:
        OSError: There is no place for it.
    """
    file = state_root() / "copies" / hashlib.sha256(content.encode()).hexdigest()[:16] / name
    if file.is_file():
        return file
    file.parent.mkdir(parents=True, exist_ok=True)
    with NamedTemporaryFile("w", encoding="utf-8", dir=file.parent, delete=False) as made:
        made.write(content)
    os.replace(made.name, file)  # whoever else makes it makes the same
    return file
