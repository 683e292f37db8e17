"""Programs that define nodes and end without having made one: `python talk.py` where nothing in talk.py runs it."""

from __future__ import annotations

import atexit
import re
import sys
from pathlib import Path

_RUNS = re.compile(r"\b(run|running|serve|make|Graph|interface)\b\s*\(|\bContext\b")
"""Words of a program that runs nodes, or looks at them, in a way of its own."""
_classes: dict[str, str] = {}
"""Node classes of the main program and its file, until one of its nodes is made."""


def defined(cls: type) -> None:
    """A node class was made: if the program's own file has it, see at the end whether it was used."""
    file = getattr(sys.modules.get(cls.__module__), "__file__", None)  # which is gone at the end
    if cls.__module__ == "__main__" and file and not sys.flags.interactive:
        if not _classes:
            atexit.register(_tell)
        _classes[cls.__name__] = file


def made() -> None:
    """A node was made."""
    if _classes:
        _classes.clear()


def _tell() -> None:
    if _classes and not hasattr(sys, "last_value"):  # it has ended by itself, and not by an error
        sys.stderr.write(advice(Path(next(iter(_classes.values()))), list(_classes)))


def advice(file: Path, classes: list[str]) -> str:
    """The remark on a file that has run to its end without a node; empty if it seems to have had other plans."""
    try:
        source = file.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return ""
    if _RUNS.search(source):
        return ""
    if file.is_relative_to(Path.cwd()):
        file = file.relative_to(Path.cwd())
    what = str(file) if len(classes) == 1 else f"MODULE:{classes[0]}"
    return (
        f"{file} defines {' and '.join(classes)}, and runs nothing: graphflow run {what}, "
        f"or as its last line: graphflow.run({classes[0]})\n"
    )
