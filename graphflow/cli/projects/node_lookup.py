"""Find the node class for `graphflow run`: by MODULE:CLASS, file, module, name of a node, or ROS's PKG EXE."""

from __future__ import annotations

import os
import shlex
import sys
import traceback
from collections.abc import Sequence
from inspect import getfile
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import click

from graphflow.cli import output
from graphflow.cli.substitutes import no_package
from graphflow.errors import GraphflowError, NoClass, NoModule, RunsWhenImported, UsageFault
from graphflow.graph.model import class_meant
from graphflow.names import did_you_mean, nearest
from graphflow.reading import lenient_text, why_no_file
from graphflow.runtime.declarations.declared import snake_case
from graphflow.supervisor.launching.classes import (
    add_root,
    import_class,
    import_module_of,
    nearest_module,
    node_classes,
)
from graphflow.workspace.executables import SLIP, find, project_nodes, with_graphflow
from graphflow.workspace.installed import installed, package_of, packages_with
from graphflow.workspace.node_classes import node_classes_in
from graphflow.workspace.packages import Workspace, find_workspace
from graphflow.workspace.project import demos_root, module_of, project_root, shown
from graphflow.workspace.source_kinds import uses_ros
from graphflow.workspace.unfound import owners, why_no_package, without_executables

FOLDERS = 1000
"""Most folders that are searched for a missing file."""

if TYPE_CHECKING:
    from graphflow.runtime.node import Node


def find_class(what: str, words: Sequence[str]) -> tuple[type[Node], list[str]]:
    """Return the class that is meant, and the remaining words, which are the node's.

    Raises:
        UsageFault: There is none, or there are several, which the text lists.
        RunsWhenImported: The file is a program that runs its nodes itself.
    """
    _check_order(what, words)
    if what.endswith((".yaml", ".yml")):
        raise UsageFault(f"{what} is a graph file: graphflow up {what}")
    named, _, class_name = what.rpartition(":")
    file = Path(named if named.endswith(".py") else what)
    root = project_root(file) if file.suffix == ".py" and file.is_file() else project_root(Path.cwd())
    add_root(str(root))
    rest = list(words)
    try:
        if named.endswith(".py"):
            cls = import_class(f"{_module_of(file, root)}:{class_name}")
        elif ":" in what:
            cls = _class_of(what, named)
        elif what.endswith(".py"):
            cls = _only(_module_of(file, root))
        elif rest[:1] and (found := find(what, rest[0].removesuffix(".py"), root)) is not None:
            cls = import_class(found.class_path)
            rest = rest[1:]
        else:
            cls = _by_name(what, root, words)
    except GraphflowError as error:
        if what.endswith(".py") and isinstance(error.__cause__, RunsWhenImported):
            raise error.__cause__ from None
        raise UsageFault(f"{error}{_source_line(error.__cause__)}") from None
    if root != demos_root() and Path(getfile(cls)).is_relative_to(demos_root()):
        output.talk(f"{what}: using the one that comes with graphflow, {getfile(cls)}")
        for package in owners(what, find_workspace(Path.cwd())) if not rest else ():
            output.talk(f"that of your package {package} is run by: graphflow run {package} {what}")
    return cls, rest


def _class_of(path: str, module: str) -> type[Node]:
    """Import MODULE:CLASS; a hyphen is a common mistake for the underscore of a module's name."""
    if "-" in module:
        way = f"; or run its file: graphflow run {module.replace('.', '/')}.py"
        raise UsageFault(f"{path!r} is not a class; {class_meant(path)}{way}")
    return import_class(path)


def _by_name(what: str, root: Path, words: Sequence[str]) -> type[Node]:
    """Find a node by a word without a class: a package, a module or a node's name."""
    if (known := _executables_of(what)) and words and not words[0].startswith("-"):
        raise UsageFault(f"package {what!r} has no executable {words[0]!r} here{did_you_mean(words[0], known)}")
    if what.rpartition(".")[2][:1].isupper():
        module, _, name = what.rpartition(".")
        meant = nearest_module(module or name.lower(), str(root)) or module or f"nodes.{name.lower()}"
        found = "" if module else _class_in(root, name)
        raise UsageFault(f"{what!r}: write MODULE:CLASS, {found or f'{meant}:{name}'}")
    return _dotted(what) if "." in what else _node_by_name(what, root, words)


def _source_line(error: BaseException | None) -> str:
    """Return the line of a syntax error with Python's caret below it; empty for other errors."""
    if not isinstance(error, SyntaxError):
        return ""
    lines = traceback.format_exception_only(error)[1:-1]
    return "".join(["\n", *lines]).rstrip()


def _check_order(executable: str, words: Sequence[str]) -> None:
    """Check that an executable does not come before its package.

    Raises:
        UsageFault: It does; the text has the right order.
    """
    if not words or words[0].startswith("-") or words[0] == executable:
        return
    package = find_workspace(Path.cwd()).packages.get(words[0])
    if executable in _executables_of(words[0]) or (package is not None and package.known_as(executable)):
        fault = f"{executable!r} is an executable of the package {words[0]!r}, which comes first"
        raise UsageFault(f"{fault}: graphflow run {words[0]} {executable}")


def _dotted(what: str) -> type[Node]:
    """Return the node of a module; suggest the executable of a package that may have been meant."""
    try:
        return _only(what)
    except NoModule:
        package, _, executable = what.partition(".")
        own = find_workspace(Path.cwd()).packages.get(package)
        known = {*(own.executables if own is not None else []), *_executables_of(package)}
        if not known:
            raise
        meant = nearest(executable, known) or "|".join(sorted(known))
        raise UsageFault(f"{what!r}: {package} is a package: graphflow run {package} {meant}") from None


def _executables_of(package: str) -> list[str]:
    """Return the executables of a package that come with graphflow or are installed."""
    own = package_of(package)
    names = [name for known, name in with_graphflow() if known == package]
    return names + (own.executables if own is not None else [])


def _node_by_name(what: str, root: Path, words: Sequence[str]) -> type[Node]:
    """Find a node by name: in the project, in installed distributions, or in graphflow."""
    own = project_nodes(root)
    if what in own:
        try:
            return import_class(own[what])
        except (NoModule, NoClass) as error:
            raise GraphflowError(f'{error}; {shown(root / "pyproject.toml")} has {what} = "{own[what]}"') from None
    having = [one for one in packages_with(what) if what in one.nodes]
    if having and not (root / "nodes" / f"{what}.py").is_file():
        if len(having) > 1:
            choices = ", ".join(f"{one.name} {what}" for one in having)
            raise UsageFault(f"several packages have a node {what!r}; run one of {choices}")
        return import_class(having[0].nodes[what])
    try:
        return _only(f"nodes.{what}")
    except NoModule:
        raise UsageFault(_why_none(what, root, words)) from None


def _why_none(what: str, root: Path, words: Sequence[str]) -> str:
    """Return the error text for a name that is neither a node's nor a package's."""
    workspace = find_workspace(Path.cwd())
    packages = workspace.packages
    if what in packages and not packages[what].executables:
        compiled = sorted(packages[what].compiled)
        verb = "is" if len(compiled) == 1 else "are"
        why = f"; {', '.join(compiled)} {verb} C++, which only colcon builds" if compiled else ""
        why += packages[what].why_no_executable if compiled else without_executables(packages[what])
        return f"the package {what!r} has no executable that graphflow can run{why}"
    if words and (program := _program_of(what, words[0], root)):
        return f"{what} is a project of graphflow's; to run its program for rclpy: graphflow run {program}"
    if what == root.name and (own := project_nodes(root)):
        meant = (nearest(words[0], own) or _class_in(root, words[0].removesuffix(".py"))) if words else None
        return f"{what!r} is the project that you are in: graphflow run {meant or min(own)}"
    why_none = why_no_package(what, workspace)
    if why_none is not None:
        return why_none
    package, slash, name = what.partition("/")
    if slash and (name in _executables_of(package) or (package in packages and packages[package].known_as(name))):
        return f"{what!r} is not a node; write a space: graphflow run {package} {name}"
    if slash and Path(f"{what}.py").is_file():
        return f"there is no node {what!r}; did you mean '{what}.py'?"
    having = owners(what, workspace)
    if having:
        return f"{what!r} is an executable of {' and of '.join(having)}: graphflow run {having[0]} {what}"
    if words and not words[0].startswith("-"):  # ROS's PKG EXE
        return _no_such_package(what, words, workspace)
    known = {f.stem for folder in (root, demos_root()) for f in (folder / "nodes").glob("*.py")} | {
        *project_nodes(root)
    }
    if "/" not in what and (file := _below(Path(), f"{what}.py")) is not None:
        return f"there is no node {what!r}; did you mean '{file}'?"
    known |= {*(package for package, _ in with_graphflow()), *packages, *installed()}
    known |= {name for one in installed().values() for name in one.nodes}
    return f"there is no node {what!r}, here or with graphflow{did_you_mean(what, known)}"


def _is_verb(word: str) -> bool:
    """Whether a word is one of graphflow's own commands."""
    context = click.get_current_context(silent=True)
    top = None if context is None else context.find_root()
    return top is not None and isinstance(top.command, click.Group) and word in top.command.list_commands(top)


def _no_such_package(what: str, words: Sequence[str], workspace: Workspace) -> str:
    """Return the error text for a package that there is not, with the folder, package or verb that may be meant."""
    if _is_verb(what):
        return f"{what!r} is a command of its own: graphflow {shlex.join([what, *words])}"
    executable = words[0]
    inside = Path(what, f"{executable.removesuffix('.py')}.py")
    if inside.is_file():
        return f"{what!r} is a folder, and no package: graphflow run {shlex.quote(str(inside))}"
    if substitute := no_package(what):
        return substitute
    packages = workspace.packages
    if what in packages:
        way = f"run it in a process of its own: graphflow run {what} {executable}"
        return f"{executable!r} of the package {what!r} is not written for graphflow, and cannot be loaded; {way}"
    near = nearest(what, [*packages, *installed(), *(package for package, _ in with_graphflow())], cutoff=SLIP)
    meant = f"; did you mean {near!r}?" if near is not None else ""
    known_here = f"; {workspace.root} has {', '.join(sorted(packages))}" if packages else ""
    elsewhere = "; go to the folder that has yours in src/, or to one within it"
    return f"there is no package {what!r} in {workspace.root} or with graphflow{meant or known_here or elsewhere}"


def _module_of(file: Path, root: Path) -> str:
    """Return the name by which a file is imported from its project."""
    if not file.is_file():
        raise UsageFault(f"{file}: {why_no_file(file, f'there is no such file{_instead_of(file)}')}")
    name = ".".join(file.resolve().relative_to(root).with_suffix("").parts)
    if name in sys.stdlib_module_names or _is_loaded_from_elsewhere(name, file):
        owner = f"Python's module {name}" if name in sys.stdlib_module_names else f"the package {name}"
        raise UsageFault(f"{file}: a file of this name hides {owner}, or is hidden by it; rename it: my_{file.name}")
    return name


def _is_loaded_from_elsewhere(name: str, file: Path) -> bool:
    """Whether graphflow has imported another module of this name, which would hide the file."""
    loaded = getattr(sys.modules.get(name), "__file__", None) if "." not in name else None
    return loaded is not None and Path(loaded).resolve() != file.resolve()


def _instead_of(file: Path) -> str:
    """Suggest another file: of the same name in a folder below or with graphflow, or of a similar name."""
    above = file.parent if file.parent.is_dir() else Path()
    if (found := _below(above, file.name)) is not None:
        return f"; to start it: graphflow launch {found}" if "launch" in file.name else f"; did you mean '{found}'?"
    if file.parent.name in ("", "nodes") and (demos_root() / "nodes" / file.name).is_file():
        return f"; {file.name} comes with graphflow: graphflow run {file.stem}"
    return did_you_mean(str(file), [str(found) for found in above.glob("*.py")])


def _program_of(project: str, name: str, root: Path) -> Path | None:
    """Return the program for rclpy of a project here, or around the working directory; None if there is none."""
    folder = root if project == root.name else Path.cwd() / project
    files = [folder / inside / f"{name.removesuffix('.py')}.py" for inside in (project, "", "nodes")]
    file = next((file for file in files if file.is_file() and uses_ros(file)), None)
    if not (folder / "pyproject.toml").is_file() or file is None:
        return None
    return file.relative_to(Path.cwd()) if file.is_relative_to(Path.cwd()) else file


def _class_in(root: Path, word: str) -> str:
    """Return a node class of a project as MODULE:CLASS, found by its name or its file's; "" if there is none."""
    for at, folders, names in islice(os.walk(root), FOLDERS):
        folders[:] = sorted(folder for folder in folders if not folder.startswith((".", "venv")))
        for file in (Path(at, name) for name in sorted(names) if name.endswith(".py")):
            for cls in node_classes_in(file) if "Node" in lenient_text(file) else ():
                if word in (cls, snake_case(cls), file.stem):
                    return f"{module_of(file)[1]}:{cls}"
    return ""


def _below(above: Path, name: str) -> Path | None:
    """Return the first file of a name in a folder or below it."""
    for at, folders, names in islice(os.walk(above), FOLDERS):
        folders[:] = sorted(folder for folder in folders if not folder.startswith((".", "venv")))
        if name in names:
            return Path(at, name)
    return None


def _only(module: str) -> type[Node]:
    """Return the only node class of a module."""
    found = node_classes(import_module_of(module))
    if not found:
        raise UsageFault(f"{module} has no node class: a class that derives from graphflow.Node")
    if len(found) > 1:
        choices = ", ".join(f"{module}:{name}" for name in found)
        raise UsageFault(f"{module} has several node classes; run one of {choices}")
    return next(iter(found.values()))
