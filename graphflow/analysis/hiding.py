"""Files and folders that hide packages: with a `numpy.py` next to a program, `import numpy` imports that file."""

from __future__ import annotations

import ast
import os
import re
import sys
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from types import ModuleType

from graphflow.analysis.syntax import nodes_in
from graphflow.analysis.user_code import is_installed, is_users
from graphflow.msgs import registry
from graphflow.msgs.registry import KINDS
from graphflow.reading import found_text, parsed
from graphflow.system import SITE

_LACKING = re.compile(r"cannot import name|is not a package")
_warned: set[str] = set()
"""Packages for which the note was written."""


def hidden(error: BaseException) -> str:
    """Return a message if an import error comes from a file that hides a package; empty otherwise."""
    name = ""
    if isinstance(error, ImportError) and error.name and _LACKING.search(str(error)):
        name = error.name.partition(".")[0]
    elif isinstance(error, ModuleNotFoundError) and error.name and "." in error.name:
        top = error.name.partition(".")[0]
        name = top if (file := _file_of(top)) is not None and _is_in_package(error.name, file) else ""
    elif isinstance(error, AttributeError) and isinstance(error.obj, ModuleType):
        name = error.obj.__name__
    file = _file_of(name) if name else None
    return _text(file) if file is not None and _is_package(name, file) else ""


def warn(file: Path) -> None:
    """Write a note, once, that a file hides a package."""
    if file.stem not in _warned:
        _warned.add(file.stem)
        sys.stderr.write(f"note: {_text(file)}\n")


def hides_what_it_imports(file: Path) -> bool:
    """Whether a program has the name of a package that it imports itself."""
    name = file.stem
    if not name.isidentifier() or not _is_package(name, file):
        return False
    try:
        module = parsed(found_text(file, "replace"))
    except (OSError, SyntaxError, ValueError):
        return False  # running the file reports the error
    imported = {alias.name for node in nodes_in(module) if isinstance(node, ast.Import) for alias in node.names}
    imported |= {n.module for n in nodes_in(module) if isinstance(n, ast.ImportFrom) and n.module and not n.level}
    return name in {other.partition(".")[0] for other in imported}


def _text(file: Path) -> str:
    named = file.parent if file.name == "__init__.py" else file
    if named.is_dir() and (named.parent / "package.xml").is_file() and named.name in registry.packages():
        return f"your package {named.parent} hides ROS 2's {named.name}; rename yours, there and in its files"
    return f"{named} hides the package {named.stem}: rename it, as in my_{named.name}"


def _file_of(name: str) -> Path | None:
    """Return the user's own file that is imported under a name; None if it belongs to an installed package."""
    file = getattr(sys.modules.get(name), "__file__", None)
    if file is None and (spec := PathFinder.find_spec(name)) is not None:  # an import that failed leaves no module
        file = spec.origin
    return Path(file) if file is not None and is_users(file) and not is_installed(file) else None


def _is_package(name: str, file: Path) -> bool:
    """Whether there is a package of that name, ROS's or an installed one, besides the file."""
    if name in sys.stdlib_module_names or name in registry.packages() or name == "graphflow":
        return True
    found = _elsewhere(name, file)
    return found is not None and found.origin is not None


def _is_in_package(module: str, file: Path) -> bool:
    """Whether the package that a file hides has a module, such as `std_msgs.msg`."""
    package, part = module.split(".")[:2]
    if package in registry.packages():
        return part in KINDS and bool(registry.names_in(package, part))
    found = _elsewhere(package, file)
    folders = found.submodule_search_locations if found is not None else None
    return bool(folders) and PathFinder.find_spec(f"{package}.{part}", folders) is not None


def _elsewhere(name: str, file: Path) -> ModuleSpec | None:
    """Find a package in all folders but that of a file."""
    own = file.parents[1] if file.name == "__init__.py" else file.parent
    elsewhere = [SITE, *(entry for entry in sys.path if Path(entry or os.curdir).resolve() != own.resolve())]
    return PathFinder.find_spec(name, elsewhere)
