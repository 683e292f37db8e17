"""Node classes by their paths in graph files: import them, and describe their interfaces without running them."""

from __future__ import annotations

import linecache
import re
import sys
from importlib import import_module
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType
from typing import TYPE_CHECKING

from graphflow.analysis.hiding import hidden
from graphflow.analysis.hyphens import hyphen_hint
from graphflow.analysis.user_code import place_in
from graphflow.errors import DeclarationError, GraphflowError, NoClass, NoModule
from graphflow.msgs import registry
from graphflow.names import did_you_mean, nearest
from graphflow.reading import found_text
from graphflow.runtime.importing import importing
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.runtime.mistakes.errors.python_errors import remark_on
from graphflow.runtime.mistakes.source.slips import slips, slips_in_groups
from graphflow.runtime.node import Node
from graphflow.runtime.node_options import why_not
from graphflow.typographic import plain
from graphflow.workspace.project import INSTALLED_DEMOS, add_interfaces, demos_root

if TYPE_CHECKING:
    from graphflow.supervisor.processes.messages import InterfacesJson

_FOLDERS_BOUND = 200
"""Largest number of folders of a project that are searched for a misspelt module."""
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
    if root not in sys.path[:at]:  # an editable install may have it further behind
        sys.path.insert(at, root)


def import_class(class_path: str) -> type[Node]:
    """Import the node class at `package.module:Class`.

    Raises:
        NoModule: There is no such module; the text names the nearest, or the folder that is searched.
        NoClass: The module has no such class.
        GraphflowError: Importing it failed; the text gives the place.
    """
    module_name, _, class_name = class_path.partition(":")
    module = import_module_of(module_name, class_name)
    found = getattr(module, class_name, None)
    if found is None:
        near = _hidden(module) or did_you_mean(class_name, node_classes(module, imported=True))
        raise NoClass(f"module {module_name} has no class {class_name!r}{near}")
    if not (isinstance(found, type) and issubclass(found, Node)):
        is_rclpys = isinstance(found, type) and any(base.__module__.startswith("rclpy.") for base in found.__mro__)
        way = f"; it is one of rclpy, run by graphflow run {module.__file__}" if is_rclpys else ""
        raise GraphflowError(f"{class_path} is not a node class: it does not derive from graphflow.Node{way}")
    return found


def _hidden(module: ModuleType) -> str:
    """Return a hint if a file of the project has the name of a module that was imported from elsewhere; else empty."""
    if module.__file__ is None or any(Path(module.__file__).is_relative_to(root) for root in _roots):
        return ""
    for root in (*_roots, str(Path.cwd())):
        file = Path(root, *module.__name__.split(".")).with_suffix(".py")
        if file.is_file() and not file.samefile(module.__file__):
            return f"; {file.name} here is hidden by {module.__file__}: rename it, as in my_{file.name}"
    return ""


def import_module_of(name: str, class_name: str = "") -> ModuleType:
    """Import a module of a project.

    Args:
        class_name: The class that is needed from it, for the text of an error.

    Raises:
        NoModule: There is no such module; the text names the nearest, or the folder that is searched.
        GraphflowError: Importing it failed; the text gives the place.
    """
    bundled = f"graphflow.{name}" if name.startswith("nodes.") else ""
    try:
        with importing(name):
            return import_module(bundled if bundled and _roots[-1:] == [str(INSTALLED_DEMOS)] else name)
    except (Exception, SystemExit) as error:  # the user's module may raise anything
        if isinstance(error, ModuleNotFoundError) and error.name and name.startswith(error.name):
            if bundled and _is_there(bundled):  # a project has no such node of its own
                return import_module_of(bundled, class_name)
            text = _no_module(error.name, name, class_name, _roots[-1] if _roots else ".")
            raise NoModule(text, error.name) from None
        raise GraphflowError(f"cannot import {name}: {_where(error)}") from error


def _is_there(name: str) -> bool:
    """Return whether a module exists; the packages above it are imported."""
    try:
        return find_spec(name) is not None
    except ModuleNotFoundError:
        return False


def node_classes(module: ModuleType, *, imported: bool = False) -> dict[str, type[Node]]:
    """Return the node classes of a module, by name.

    Args:
        imported: Include classes that it imports.
    """
    found = {k: v for k, v in vars(module).items() if isinstance(v, type) and issubclass(v, Node) and v is not Node}
    return {k: v for k, v in found.items() if imported or v.__module__ == module.__name__}


def _no_module(module: str, wanted: str, class_name: str, root: str) -> str:
    """Describe the failed import of `wanted`, for lack of `module`: name the nearest, or the searched folder."""
    near = nearest_module(wanted, root)
    if near == wanted:  # it exists, but another package of that name comes before it on sys.path
        top = wanted.partition(".")[0]
        taken = getattr(sys.modules.get(top), "__file__", None)
        return f"cannot import {wanted}: {top!r} is {taken}; give the package in {root} another name"
    meant = f"{near}:{class_name}" if class_name else near
    hint = f"; did you mean {meant!r}?"
    if near is None:
        parent, _, last = module.rpartition(".")
        beside = [m.name for m in iter_modules(getattr(sys.modules.get(parent), "__path__", []))]
        hint = _other_project(module, Path(root)) or _in_source_folder(wanted, Path(root)) or _below(wanted, Path(root))
        hint = hint or did_you_mean(last, beside) or _above(module, Path(root)) or _bundled(wanted)
        hint = hint or f"; modules are looked for in {root}"
    return f"cannot import {wanted}: there is no module {module!r}{hint}"


def _other_project(module: str, root: Path) -> str:
    """Suggest to install the project beside or below this one that has a missing module."""
    top = module.partition(".")[0]
    for folder in (root, root.parent):
        if (folder / top / "pyproject.toml").is_file() and (folder / top / top).is_dir():
            way = f"cd {folder / top}; others find its modules once it is installed: pip install -e {folder / top}"
            return f"; {folder / top} is a project of its own: {way}"
    return ""


def _below(wanted: str, root: Path) -> str:
    """Suggest to make a folder of the project, which has a missing module, a project of its own."""
    path = Path(*wanted.split(".")).with_suffix(".py")
    for folder in islice(root.iterdir(), _FOLDERS_BOUND):
        if (folder / path).is_file():
            way = f"make {folder} a project of its own: touch {folder / 'pyproject.toml'}"
            return f"; modules are looked for in {root}, and {path} is in {folder}: {way}"
    return ""


def _above(module: str, root: Path) -> str:
    """Suggest what makes a folder above, which has a missing module, the project's root."""
    top = module.partition(".")[0]
    for folder in list(root.parents)[:2]:
        if (folder / top).is_dir() or (folder / f"{top}.py").is_file():
            made = folder / "pyproject.toml"
            missing = f"the graph file is in {folder / 'graphs'}" if made.is_file() else f"there is a file {made}"
            return f"; modules are looked for in {root}; that of {folder} is found once {missing}"
    return ""


def _in_source_folder(wanted: str, root: Path) -> str:
    """Suggest to move a module out of the folder `src` of the project, or of the folder above."""
    for folder in (root, root.parent):
        if (folder / "src" / f"{wanted.replace('.', '/')}.py").is_file():
            found = folder / "src" / wanted.partition(".")[0]
            return f"; {found} is not found there: move it to {folder}, and the graph file to {folder / 'graphs'}"
    return ""


def _bundled(wanted: str) -> str:
    """Suggest the node that comes with graphflow and is most like a missing module; empty if none is."""
    folder = demos_root() / "nodes"
    files = {file.stem: file for file in sorted(folder.glob("*.py"))}
    is_robot = re.search("turtlebot|gazebo|simulator", wanted.lower()) is not None
    near = "robot_simulator" if is_robot else nearest(wanted.rpartition(".")[2], files, cutoff=0.75)
    if near is None or near not in files:
        return ""
    text = found_text(files[near])
    found = re.findall(r"^class (\w+)\((?:LifecycleNode|Node|SimulationServices)\)", text, re.MULTILINE)
    return f"; did you mean 'nodes.{near}:{found[0]}', which comes with graphflow?" if found else ""


def nearest_module(module: str, root: str) -> str | None:
    """Return the full name of the project's module whose name is most like that of a missing one.

    One of that very name in a subfolder comes first, then those of the same package, of the folder and its subfolders.
    """
    parent, _, last = module.rpartition(".")
    beside = getattr(sys.modules.get(parent), "__path__", [root] if not parent else [])
    folders = islice((f for f in sorted(Path(root).iterdir()) if f.name.isidentifier() and f.is_dir()), _FOLDERS_BOUND)
    inner = [(folder.name, [str(folder)]) for folder in folders]
    same = next((f"{at}.{last}" for at, paths in inner if last in {m.name for m in iter_modules(paths)}), None)
    if same is not None:
        return same
    for places in ([(parent, beside)], [("", [root]), *inner]):
        known = {m.name: f"{at}.{m.name}".lstrip(".") for at, paths in reversed(places) for m in iter_modules(paths)}
        near = nearest(last, known)
        if near is not None:
            return known[near]
    return None


def _where(error: BaseException) -> str:
    """Describe an error on one line, with its place in the user's code and advice."""
    if isinstance(error, SyntaxError):
        line = (error.text or "").strip()
        hint = f"; write {plain(line)}" if "invalid character" in error.msg and plain(line) != line else ""
        return f"{error.filename}:{error.lineno}: {error.msg}{hint or hyphen_hint(line)}"
    place = place_in(error)
    explain(error)
    text = str(error)
    missing = (error.name or "").partition(".")[0] if isinstance(error, ModuleNotFoundError) else ""
    if is_hidden := hidden(error):
        text += f"; {is_hidden}"
    elif missing in registry.packages():
        text += f"; write graphflow.msgs.{error.name}"  # type: ignore[attr-defined]
    elif missing == "graphflow" and error.name and (meant := _instead_of(error.name.split(".")[1])):  # type: ignore[attr-defined]
        text += f"; {meant}"
    elif found := re.fullmatch(r"cannot import name '(\w+)' from 'graphflow' .*", text):
        text = f"graphflow has no {found[1]}; {_instead_of(found[1])}".removesuffix("; ")
    elif missing == "rclpy":
        text += '; write `from graphflow import Node`: the page "coming from ROS 2" has each word of rclpy'
    elif (near := nearest(missing, ["rclpy", "graphflow"], cutoff=0.75)) is not None:
        text += f"; did you mean {near!r}?"
    elif missing in ("rospy", "roscpp", "roslib"):
        text += f"; {missing} is ROS 1's: write `from graphflow import Node`, or ROS 2's import rclpy"
    elif remark := remark_on(error) or _advise_on_sibling(error, place):
        text += f"; {remark}"
    # A declaration's error gives the place of the declaration, which is nearer to the mistake than the raising frame.
    return text if text.startswith("/") else f"{place}{place and ': '}{type(error).__name__}: {text}"


def _advise_on_sibling(error: BaseException, place: str) -> str:
    """Return advice on the import of a module in the same folder; empty if there is none.

    A program finds modules in its own folder; a module of a package is found from the project's folder.
    """
    path, _, number = place.rpartition(":")
    file, written = Path(path), _IMPORT.match(linecache.getline(path, int(number)) if number else "")
    if "no known parent package" in str(error):
        return _as_module(file)
    if not isinstance(error, ModuleNotFoundError) or written is None:
        return ""
    module, names = written[1] or written[3], written[2]
    top, _, rest = module.partition(".")
    if file.parent.name == top and rest and _lies_in(file.parent, rest):
        return _as_module(file)
    package = _package_of(file)
    if not package or error.name != top or not _lies_in(file.parent, top):
        return ""
    above, _, last = f"{package}.{module}".rpartition(".")
    return f"write from {package}.{module} import {names.strip()}" if names else f"write from {above} import {last}"


_IMPORT = re.compile(r"\s*(?:from\s+([\w.]+)\s+import\s+([^#\n]+)|import\s+([\w.]+)\s*(?:#|$))")
"""Matches an import of names from a module, or of one module."""


def _lies_in(folder: Path, module: str) -> bool:
    path = folder / module.partition(".")[0]
    return path.with_suffix(".py").is_file() or path.is_dir()


def _as_module(file: Path) -> str:
    """Describe how to run a file that imports from its own package."""
    package, above = file.parent.name, file.parent.parent
    return f"run it as a module of {package}: graphflow run {package}.{file.stem}, in {above}"


def _package_of(file: Path) -> str:
    """Return the package of a module of the project; empty for none."""
    root = next((root for root in reversed(_roots) if file.is_relative_to(root)), None)
    return "" if root is None else ".".join(file.relative_to(root).parent.parts)


def _instead_of(word: str) -> str:
    """Return advice on the import of a name that graphflow does not have; empty if there is none."""
    if word in ("msg", "srv", "action", "message", "messages"):
        return "messages are in graphflow.msgs, as in from graphflow.msgs.std_msgs.msg import String"
    names: list[str] = vars(sys.modules["graphflow"])["__all__"]  # the facade above, which the user's file imports
    meant = {name.lower(): name for name in names}
    near = nearest(word.lower(), meant)
    return f"write from graphflow import {meant[near]}" if near is not None else ""


def interfaces(class_paths: list[str], *, with_slips: bool = False) -> InterfacesJson:
    """Return interfaces as JSON by class path; for a class that cannot be imported, `{"problem": text}`.

    Each also has `needs_numpy`, whether nodes of the class will load NumPy, and with `with_slips` the mistakes in its
    source that a node logs when it starts, and those that are foreseen; those that other groups may prevent are apart.
    """
    found: InterfacesJson = {}
    for path in class_paths:
        try:
            cls = import_class(path)
            reason = why_not(cls)
            if reason:
                raise DeclarationError(f"{cls.interface().place}: {reason}")
            interface = cls.interface()
            has_arrays = any(registry.has_numeric_arrays(e.type) for e in interface.endpoints if e.type)
            found[path] = {**interface.to_json(), "needs_numpy": has_arrays or "numpy" in sys.modules}
            if with_slips:
                from graphflow.runtime.mistakes.source.foreseen import check_init, foreseen  # nodes do not need it

                check_init(cls)
                kind: type = cls  # the type checker knows that one can be hashed, but not a Node's class
                found[path]["slips"] = [*slips(kind), *foreseen(cls)]
                found[path]["slips_in_groups"] = [*slips_in_groups(kind)]
        except GraphflowError as error:
            found[path] = {"problem": str(error)}
    return found
