"""Programs that end without having run a node: `python talk.py`, where nothing in talk.py runs the class it defines."""

from __future__ import annotations

import atexit
import re
import sys
from collections.abc import Collection
from pathlib import Path

from graphflow.analysis.discarded import discarded
from graphflow.analysis.uncalled import uncalled
from graphflow.analysis.user_code import is_installed, is_ours, place_in
from graphflow.reading import found_text
from graphflow.runtime.callables import file_of
from graphflow.runtime.mistakes.errors.attribute_errors import better_text

_RUNS = re.compile(r"\b(run|running|serve|make|Graph|interface)\b\s*\(|\bContext\b")
"""Names in programs that run or inspect nodes in another way."""
_MAIN_CALLS = re.compile(r"^if __name__ == .*:\n(?:[ \t].*\n|\n)*?[ \t]+[^#\n]*\w\(", re.MULTILINE)
"""A main block that calls something, which is what the file is run for."""
_IMPORTS = re.compile(r"^import graphflow\b(?!\.)", re.MULTILINE)
_classes: list[str] = []
"""Node classes defined in the program's own file."""
_file: str | None = None
"""The program's file, once it is watched."""
_made: set[str] = set()
"""Names of classes whose nodes the program has made."""
_has_run = False


def defined(cls: type) -> None:
    """Note the definition of a node class; an unused one is reported at exit."""
    if cls.__module__ == "__main__":
        _classes.append(cls.__name__)
    watch()


def watch() -> None:
    """Check at exit whether the program has run a node."""
    global _file
    file = file_of(sys.modules.get("__main__"))  # the attribute is gone at exit
    if file and _file is None and not (_has_run or sys.flags.interactive or is_ours(file) or is_installed(file)):
        _file = file
        atexit.register(_at_exit)


def made(cls: type) -> None:
    """Note that a node was made."""
    _made.add(cls.__name__)


def ran() -> None:
    """Note that a node has joined a network, or that rclpy was initialized."""
    global _has_run
    _has_run = True


def _at_exit() -> None:
    error = getattr(sys, "last_value", None)
    if isinstance(error, AttributeError) and error.name is not None and (better := better_text(error)):
        sys.stderr.write(f"{place_in(error)}: {better}\n")  # Python has printed the error itself
    if isinstance(error, (NameError, TypeError)) and "rclpy" not in sys.modules:  # whose programs have had theirs
        from graphflow.runtime.mistakes.errors.python_errors import remark_on  # most programs never need it

        if (way := remark_on(error)) and way not in getattr(error, "__notes__", ()):
            sys.stderr.write(f"{place_in(error)}: {way}\n")
    if isinstance(error, ModuleNotFoundError) and error.name and _file is not None:
        sys.stderr.write(_as_module(Path(_file).resolve(), error.name))
    if _file is not None and not hasattr(sys, "last_value"):  # the program ended normally, without an error
        report(Path(_file))


def report(file: Path) -> None:
    """Report once that a program has ended without running its nodes."""
    if not _has_run:
        ran()
        sys.stderr.write(advice(file, _classes, _made))


def _as_module(file: Path, missing: str) -> str:
    """Return the command that runs a file of a package, if it lacks that package; "" if it lacks another."""
    package = file.parent.name
    if missing.partition(".")[0] != package:
        return ""
    source = found_text(file, "replace")
    is_program = re.search(r"__main__|\basyncio\.run\(", source) is not None
    run = f"{'python -m' if is_program else 'graphflow run'} {package}.{file.stem}, in {file.parents[1]}"
    return f"to run a file of {package}, which imports {missing}: {run}\n"


def advice(file: Path, classes: list[str], made: Collection[str] = ()) -> str:
    """Return a remark on a file that ended without running a node; "" if that seems intended.

    Args:
        classes: The node classes that it defines.
        made: Those whose nodes it has made, which it may want only to look at.
    """
    try:
        source = found_text(file)
    except (OSError, ValueError):
        return ""
    if file.is_relative_to(Path.cwd()):
        file = file.relative_to(Path.cwd())
    if made:
        text = discarded(source, str(file), made)
        return f"{text}\n" if text else ""
    if text := uncalled(source, str(file)):
        return f"{text}\n"
    if _RUNS.search(source) or _MAIN_CALLS.search(source) or not classes:
        return ""
    what = str(file) if len(classes) == 1 else f"MODULE:{classes[0]}"
    line = f"graphflow.run({classes[0]})"
    way = f"as its last line: {line}" if _IMPORTS.search(source) else f"as its last lines: import graphflow; {line}"
    return f"{file} defines {' and '.join(classes)}, but runs nothing: graphflow run {what}, or {way}\n"


watch()  # once a program imports nodes, native ones or rclpy's
