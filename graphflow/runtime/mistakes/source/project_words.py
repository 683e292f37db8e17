"""The other files of a project, and the words in them: whether anything there refers to a definition."""

from __future__ import annotations

import ast
import os
import re
import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from itertools import islice
from pathlib import Path

from graphflow.analysis.syntax import syntax_of
from graphflow.analysis.user_code import is_installed
from graphflow.reading import found_text, lenient_text
from graphflow.runtime.callables import file_of

FOLDERS_BOUND, FILES_BOUND, DEPTH = 200, 500, 3
"""Folders of a project that are searched for files that are not loaded, the files, and the levels of folders."""
SIZE_BOUND = 1_000_000
"""Bytes of a file that is searched, at most: the source of a node is far smaller."""
_OF_TOOLS = ("build", "install", "log", "site-packages", "node_modules", "venv")
"""Folders of a project with files that are not its own."""


def other_modules(file: str, word: str) -> Iterator[ast.Module]:
    """Parse the project's other modules that contain a word; they may use a definition of the file by that name."""
    from graphflow.workspace.project import project_root

    root = project_root(Path(file))
    others = {str(path) for module in list(sys.modules.values()) if (path := file_of(module))}
    for other in sorted(others - {file}):
        if other.endswith(".py") and Path(other).is_relative_to(root) and not is_installed(other):
            with suppress(OSError, SyntaxError, ValueError):  # no readable source
                # Most do not contain it, and need not be parsed, which takes milliseconds each.
                if word in _text(other):
                    yield syntax_of(other).module


def is_in_other_files(file: str, word: str) -> bool:
    """Return whether another file of the project, loaded or not, has a word as an attribute or a string.

    `graphflow.run` and a test's `graph.start` are none of a node's.
    """
    from graphflow.workspace.project import project_root

    pattern = re.compile(rf"(?:(?<!\bgraphflow)(?<!\bgraph)\.|[\"']){word}\b")
    return any(
        path != file and pattern.search(lenient_text(Path(path), SIZE_BOUND))
        for path in _files(str(project_root(Path(file))))
    )


@cache
def _files(root: str) -> tuple[str, ...]:
    """Return the Python files of a project, as far as they are found soon: a root may be anybody's home."""
    found: list[str] = []
    for at, folders, names in islice(os.walk(root), FOLDERS_BOUND):
        is_deep = len(Path(at).relative_to(root).parts) >= DEPTH
        folders[:] = [] if is_deep else [n for n in folders if not n.startswith(".") and n not in _OF_TOOLS]
        found += [os.path.join(at, name) for name in names if name.endswith(".py")]
        if len(found) > FILES_BOUND:
            break
    return tuple(found[:FILES_BOUND])


@cache
def _text(file: str) -> str:
    return found_text(Path(file))
