"""Programs that end without having run a node: `python talk.py` where nothing in talk.py runs what it defines."""

from __future__ import annotations

import atexit
import re
import sys
from pathlib import Path

from graphflow.analysis.uncalled import uncalled
from graphflow.analysis.user_code import is_installed, is_ours, place_in
from graphflow.runtime.mistakes.errors.attribute_errors import better_text

_RUNS = re.compile(r"\b(run|running|serve|make|Graph|interface)\b\s*\(|\bContext\b")
"""Words of a program that runs nodes, or looks at them, in a way of its own."""
_classes: list[str] = []
"""Node classes of the program's own file."""
_file: str | None = None
"""The program's file, once it is watched."""
_has_run = False


def defined(cls: type) -> None:
    """A node class was made: see at the end whether one was used."""
    if cls.__module__ == "__main__":
        _classes.append(cls.__name__)
    watch()


def watch() -> None:
    """See at the end of the program whether it has run anything."""
    global _file
    file = getattr(sys.modules.get("__main__"), "__file__", None)  # which is gone at the end
    if file and _file is None and not (_has_run or sys.flags.interactive or is_ours(file) or is_installed(file)):
        _file = file
        atexit.register(_tell)


def made() -> None:
    """A node was made, or rclpy begun."""
    global _has_run
    _has_run = True


def _tell() -> None:
    error = getattr(sys, "last_value", None)
    if isinstance(error, AttributeError) and error.name is not None and (better := better_text(error)):
        sys.stderr.write(f"{place_in(error)}: {better}\n")  # Python has written the error itself
    if _file is not None and not hasattr(sys, "last_value"):  # it has ended by itself, and not by an error
        tell(Path(_file))


def tell(file: Path) -> None:
    """Say why a program that has ended has run nothing, unless it has; once."""
    if not _has_run:
        made()
        sys.stderr.write(advice(file, _classes))


def advice(file: Path, classes: list[str]) -> str:
    """The remark on a file that has run to its end without a node; empty if it seems to have had other plans."""
    try:
        source = file.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return ""
    if file.is_relative_to(Path.cwd()):
        file = file.relative_to(Path.cwd())
    if text := uncalled(source, str(file)):
        return f"{text}\n"
    if _RUNS.search(source) or not classes:
        return ""
    what = str(file) if len(classes) == 1 else f"MODULE:{classes[0]}"
    return (
        f"{file} defines {' and '.join(classes)}, and runs nothing: graphflow run {what}, "
        f"or as its last line: graphflow.run({classes[0]})\n"
    )
