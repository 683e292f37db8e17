"""Which node class `graphflow run` means: MODULE:CLASS, a file, a module, a bundled node's name, or ROS's PKG EXE."""

from __future__ import annotations

from collections.abc import Sequence
from inspect import getfile
from pathlib import Path
from typing import TYPE_CHECKING

from graphflow.cli import output
from graphflow.errors import GraphflowError, NoModule, UsageFault
from graphflow.graph.executables import SLIP, find, project_nodes, with_graphflow
from graphflow.graph.installed import installed, package_of, packages_with
from graphflow.graph.project import demos_root, project_root
from graphflow.graph.unfound import owners, why_no_package
from graphflow.graph.workspace import find_workspace
from graphflow.names import did_you_mean, nearest
from graphflow.supervisor.classes import add_root, import_class, import_module_of, node_classes

if TYPE_CHECKING:
    from graphflow.runtime.node import Node


def find_class(what: str, words: Sequence[str]) -> tuple[type[Node], list[str]]:
    """The class that is meant, and the words that are left for the node.

    Raises:
        UsageFault: There is none, or several; the text says which there are.
    """
    root = project_root(Path(what)) if what.endswith(".py") and Path(what).is_file() else project_root(Path.cwd())
    add_root(str(root))
    rest = list(words)
    try:
        if ":" in what:
            cls = import_class(what)
        elif what.endswith(".py"):
            cls = _only(_module_of(Path(what), root))
        elif rest[:1] and (found := find(what, rest[0].removesuffix(".py"), root)) is not None:
            cls = import_class(found.class_path)
            rest = rest[1:]
        elif (known := _executables_of(what)) and rest[:1] and not rest[0].startswith("-"):
            raise UsageFault(f"package {what!r} has no executable {rest[0]!r} here{did_you_mean(rest[0], known)}")
        elif what.rpartition(".")[2][:1].isupper():
            module, _, name = what.rpartition(".")
            raise UsageFault(f"{what!r}: write MODULE:CLASS, {module or f'nodes.{name.lower()}'}:{name}")
        else:
            cls = _only(what) if "." in what else _named(what, root, words)
    except GraphflowError as error:
        raise UsageFault(str(error)) from None
    if root != demos_root() and Path(getfile(cls)).is_relative_to(demos_root()):
        output.talk(f"{what}: using the one that comes with graphflow, {getfile(cls)}")
    return cls, rest


def _executables_of(package: str) -> list[str]:
    """The executables of a package that come with graphflow or are installed."""
    own = package_of(package)
    names = [name for known, name in with_graphflow() if known == package]
    return names + (own.executables if own is not None else [])


def _named(what: str, root: Path, words: Sequence[str]) -> type[Node]:
    """The node of a module in `nodes/` of the project, of an installed distribution, or of graphflow."""
    own = project_nodes(root)
    if what in own:
        return import_class(own[what])
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
    """The error text where there is neither a node nor a package of that name."""
    workspace = find_workspace(Path.cwd())
    packages = workspace.packages
    if what in packages and not packages[what].executables:
        compiled = sorted(packages[what].compiled)
        verb = "is" if len(compiled) == 1 else "are"
        why = f"; {', '.join(compiled)} {verb} C++, which only colcon builds" if compiled else ""
        return f"the package {what!r} has no executable that graphflow can run{why}"
    why_none = why_no_package(what, workspace)
    if why_none is not None:
        return why_none
    has = owners(what, workspace)
    if has:
        return f"{what!r} is an executable of {' and of '.join(has)}: graphflow run {has[0]} {what}"
    known = {f.stem for folder in (root, demos_root()) for f in (folder / "nodes").glob("*.py")} | {
        *project_nodes(root)
    }
    if words and not words[0].startswith("-"):  # ROS's PKG EXE
        near = nearest(what, [*packages, *installed(), *(package for package, _ in with_graphflow())], cutoff=SLIP)
        meant = f"; did you mean {near!r}?" if near is not None else ""
        there = f"; {workspace.root} has {', '.join(sorted(packages))}" if packages else ""
        return f"there is no package {what!r} in {workspace.root} or with graphflow{meant or there}"
    known |= {*(package for package, _ in with_graphflow()), *packages, *installed()}
    known |= {name for one in installed().values() for name in one.nodes}
    return f"there is no node {what!r}, here or with graphflow{did_you_mean(what, known)}"


def _module_of(file: Path, root: Path) -> str:
    """The name by which a file is imported from its project."""
    if not file.is_file():
        near = [str(p) for p in file.parent.glob("*.py")] if file.parent.is_dir() else []
        raise UsageFault(f"{file}: there is no such file{did_you_mean(str(file), near)}")
    return ".".join(file.resolve().relative_to(root).with_suffix("").parts)


def _only(module: str) -> type[Node]:
    """The one node class of a module."""
    found = node_classes(import_module_of(module))
    if not found:
        raise UsageFault(f"{module} has no node class: a class that derives from graphflow.Node")
    if len(found) > 1:
        choices = ", ".join(f"{module}:{name}" for name in found)
        raise UsageFault(f"{module} has several node classes; run one of {choices}")
    return next(iter(found.values()))
