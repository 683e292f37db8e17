"""Node classes by their paths, as graph files name them: imported, and described without being run."""

from __future__ import annotations

import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType
from typing import Any

from graphflow.errors import DeclarationError, GraphflowError, NoModule, Place, Problem
from graphflow.graph.project import INSTALLED_DEMOS, PACKAGE, add_interfaces
from graphflow.interface import Interface
from graphflow.msgs import registry
from graphflow.names import did_you_mean
from graphflow.runtime.node import Node
from graphflow.runtime.surroundings import why_not

_roots: list[str] = []


def add_root(root: str) -> None:
    """Make modules and interfaces of the project at `root` importable.

    Before the installed packages, so that a project's own `nodes` is never shadowed; after the standard library, so
    that a file that happens to be called `queue.py` breaks nothing.
    """
    _roots.append(root)
    add_interfaces(Path(root))
    installed = (i for i, entry in enumerate(sys.path) if entry.endswith(("site-packages", "dist-packages")))
    at = next(installed, len(sys.path))
    if root not in sys.path[:at]:  # it may be behind, after another project that is installed to be edited
        sys.path.insert(at, root)


def import_class(class_path: str) -> type[Node]:
    """The node class at `package.module:Class`.

    Raises:
        NoModule: There is no such module; the text names the nearest, or where modules are looked for.
        GraphflowError: The module has no such class, or importing it failed; the text says where.
    """
    module_name, _, class_name = class_path.partition(":")
    module = import_module_of(module_name)
    found = getattr(module, class_name, None)
    if found is None:
        near = did_you_mean(class_name, node_classes(module, imported=True))
        raise GraphflowError(f"module {module_name} has no class {class_name!r}{near}")
    if not (isinstance(found, type) and issubclass(found, Node)):
        raise GraphflowError(f"{class_path} is not a node class: it does not derive from graphflow.Node")
    return found


def import_module_of(name: str) -> ModuleType:
    """A module of a project.

    Raises:
        NoModule: There is no such module; the text names the nearest, or where modules are looked for.
        GraphflowError: Importing it failed; the text says where.
    """
    bundled = f"graphflow.{name}" if name.startswith("nodes.") else ""
    try:
        return import_module(bundled if bundled and _roots[-1:] == [str(INSTALLED_DEMOS)] else name)
    except (Exception, SystemExit) as error:
        if isinstance(error, ModuleNotFoundError) and error.name and name.startswith(error.name):
            if bundled and _is_there(bundled):  # a project has no such node of its own
                return import_module_of(bundled)
            raise NoModule(_no_module(error.name, name, _roots[-1] if _roots else "."), error.name) from None
        raise GraphflowError(f"cannot import {name}: {_where(error)}") from error


def _is_there(name: str) -> bool:
    """Whether there is a module of that name; the packages above it are imported."""
    try:
        return find_spec(name) is not None
    except ModuleNotFoundError:
        return False


def node_classes(module: ModuleType, *, imported: bool = False) -> dict[str, type[Node]]:
    """The node classes of a module, by name.

    Args:
        imported: Those that it has from elsewhere too.
    """
    found = {k: v for k, v in vars(module).items() if isinstance(v, type) and issubclass(v, Node) and v is not Node}
    return {k: v for k, v in found.items() if imported or v.__module__ == module.__name__}


def _no_module(module: str, wanted: str, root: str) -> str:
    """What is said when `wanted` cannot be imported for want of `module`: the nearest, or where it was looked for."""
    parent, _, last = module.rpartition(".")
    package = sys.modules.get(parent)
    known = [m.name for m in iter_modules(getattr(package, "__path__", None) if parent else [root])]
    hint = did_you_mean(last, known) or f"; modules are looked for in {root}"
    return f"cannot import {wanted}: there is no module {module!r}{hint}"


def _where(error: BaseException) -> str:
    """The error on one line, with the place in the user's code it came from."""
    if isinstance(error, SyntaxError):
        return f"{error.filename}:{error.lineno}: {error.msg}"
    frame, place = error.__traceback__, ""
    while frame is not None:
        file = frame.tb_frame.f_code.co_filename
        if not file.startswith(("<frozen", str(PACKAGE))) and not file.endswith("importlib/__init__.py"):
            place = f"{file}:{frame.tb_lineno}: "
        frame = frame.tb_next
    text = str(error)
    missing = (error.name or "").partition(".")[0] if isinstance(error, ModuleNotFoundError) else ""
    if missing in registry.packages():
        text += f"; write graphflow.msgs.{error.name}"  # type: ignore[attr-defined]
    elif missing == "rclpy":
        text += '; write `from graphflow import Node`: the page "coming from ROS 2" has each word of rclpy'
    # A declaration's error names its own place, which is nearer to the mistake than the frame it was raised in.
    return text if text.startswith("/") else f"{place}{type(error).__name__}: {text}"


def interfaces(class_paths: list[str]) -> dict[str, Any]:
    """Interfaces as JSON by class path; for a class that cannot be imported, `{"problem": text}`.

    Beside each stands `needs_numpy`: whether nodes of the class will load it.
    """
    found: dict[str, Any] = {}
    for path in class_paths:
        try:
            cls = import_class(path)
            reason = why_not(cls)
            if reason:
                raise DeclarationError(f"{cls.interface().place}: {reason}")
            interface = cls.interface()
            has_arrays = any(registry.has_numeric_arrays(e.type) for e in interface.endpoints if e.type)
            found[path] = {**interface.to_json(), "needs_numpy": has_arrays or "numpy" in sys.modules}
        except GraphflowError as error:
            found[path] = {"problem": str(error)}
    return found


def read_interfaces(data: dict[str, Any]) -> dict[str, Any]:
    """What `interfaces` returned, as Interfaces and Problems."""
    return {
        path: Problem(Place(""), value["problem"]) if "problem" in value else Interface.from_json(value)
        for path, value in data.items()
    }
