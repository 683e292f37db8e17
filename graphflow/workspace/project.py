"""Places of a project: its root, graph files and interfaces, and the bundled ones."""

from __future__ import annotations

import os
from pathlib import Path

from graphflow.msgs import registry
from graphflow.names import nearest
from graphflow.workspace import installed
from graphflow.workspace.installed import SITE_FOLDERS
from graphflow.workspace.packages import find_workspace

PACKAGE = Path(__file__).resolve().parents[1]
INSTALLED_DEMOS = PACKAGE / "demos"
"""The folder of `graphs/` and `nodes/` in the wheel."""


def project_root(path: Path) -> Path:
    """Return the folder from which a graph file's classes are imported.

    It is the nearest folder above with a `pyproject.toml` and a `graphs/` or `nodes/`, else the one with the file's
    `graphs/` and a `nodes/` beside it, else the file's own folder. The project of the graphs in an installed graphflow
    is the folder with the nodes beside them.
    """
    start = path.resolve()
    found = _marked_above(start)
    if found is not None:
        return found
    folder = start if start.is_dir() else start.parent
    return folder.parent if folder.name == "graphs" and (folder.parent / "nodes").is_dir() else folder


def _marked_above(start: Path) -> Path | None:
    """Return the nearest folder with the files of a project's root; None if there is none."""
    if start.is_relative_to(INSTALLED_DEMOS):
        return INSTALLED_DEMOS
    for folder in [start, *start.parents]:
        if folder.name in SITE_FOLDERS:  # a virtual environment may be inside another project
            break
        if (folder / "pyproject.toml").is_file() and ((folder / "graphs").is_dir() or (folder / "nodes").is_dir()):
            return folder
    return None


def module_of(file: Path) -> tuple[Path, str]:
    """Return the folder from which a file's classes are imported, and its module name there.

    The folder is the file's project; without one, it is the project of the working directory, if the file is below it.
    """
    here, path = project_root(Path.cwd()), file.resolve()
    root = _marked_above(path) or (here if path.is_relative_to(here) else project_root(path))
    return root, ".".join(path.relative_to(root).with_suffix("").parts)


def add_interfaces(root: Path) -> None:
    """Register the interfaces in a project's `interfaces/`, in its workspace and in installed distributions."""
    folder = root / "interfaces"
    if folder.is_dir():
        registry.add_root(folder)
    registry.add_later(installed.interfaces)
    registry.add_later(lambda: {package.name: package.folder for package in find_workspace(root).packages.values()})


def demos_root() -> Path:
    """Return the folder with the bundled `graphs/` and `nodes/`: in the installed package, or in the repository."""
    return INSTALLED_DEMOS if INSTALLED_DEMOS.is_dir() else PACKAGE.parent


def bundled_graphs() -> dict[str, Path]:
    """Return the bundled graphs, by name: `turtlesim`, `deadlock/crossing_broken`."""
    folder = demos_root() / "graphs"
    return {f.relative_to(folder).with_suffix("").as_posix(): f for f in sorted(folder.rglob("*.yaml"))}


def no_file(path: Path, elsewhere: str = "") -> str:
    """Return the message for a file that does not exist, with the most similar name.

    Args:
        elsewhere: The right form of the path, if it is known.
    """
    if path.exists():
        return f"{shown(path)} is not a regular file"
    if hint := home_hint(path):
        return f"there is no file {shown(path)}{hint}"
    if elsewhere:
        return f"there is no file {shown(path)}; write {elsewhere}"
    if elsewhere := _from_root(path):
        return f"there is no file {shown(path)}; a path begins at the file that has it: write {elsewhere}"
    beside = {file.stem: file.name for file in path.parent.glob("*.*")}
    found = beside.get(nearest(path.stem, beside) or "")
    return f"there is no file {shown(path)}" + (f"; did you mean {found!r}?" if found else "")


def _from_root(path: Path) -> str:
    """Return the right form of a missing path that was written relative to the project's root; empty for others."""
    root = project_root(path)
    parts = path.relative_to(root).parts if path.is_relative_to(root) else ()
    for i in range(1, len(parts)):
        if (found := root.joinpath(*parts[i:])).is_file():
            return os.path.relpath(found, root.joinpath(*parts[:i]))
    return ""


def home_hint(path: Path) -> str:
    """Return the correction of a path of a graph file that begins with `~`; empty for others."""
    if "~" not in path.parts:
        return ""
    inside = "/".join(path.parts[path.parts.index("~") + 1 :])
    return f"; ~ is not expanded: write $(env HOME)/{inside}"


def shown(path: Path) -> str:
    """Return a path as messages show it: relative to the working directory if it is below."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except ValueError:
        return str(path)
