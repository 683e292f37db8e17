"""Where things are: a project's root, its graph files and interfaces, and those that come with graphflow."""

from __future__ import annotations

from pathlib import Path

from graphflow.msgs import registry
from graphflow.names import nearest
from graphflow.workspace import installed
from graphflow.workspace.installed import SITE_FOLDERS
from graphflow.workspace.packages import find_workspace

PACKAGE = Path(__file__).resolve().parents[1]
INSTALLED_DEMOS = PACKAGE / "demos"
"""Where the wheel puts `graphs/` and `nodes/`."""


def project_root(path: Path) -> Path:
    """The folder that a graph file's classes are imported from.

    The nearest folder above with a `pyproject.toml` and a `graphs/` or `nodes/`, else the one with the file's `graphs/`
    and a `nodes/` beside it, else the file's own folder. The graphs inside an installed graphflow have the nodes next
    to them as their project.
    """
    start = path.resolve()
    found = _marked_above(start)
    if found is not None:
        return found
    folder = start if start.is_dir() else start.parent
    return folder.parent if folder.name == "graphs" and (folder.parent / "nodes").is_dir() else folder


def _marked_above(start: Path) -> Path | None:
    """The nearest folder that says by its files that it is a project's root."""
    if start.is_relative_to(INSTALLED_DEMOS):
        return INSTALLED_DEMOS
    for folder in [start, *start.parents]:
        if folder.name in SITE_FOLDERS:  # of a virtual environment, which may lie in another project
            break
        if (folder / "pyproject.toml").is_file() and ((folder / "graphs").is_dir() or (folder / "nodes").is_dir()):
            return folder
    return None


def module_of(file: Path) -> tuple[Path, str]:
    """The folder that a file's classes are imported from, and its name there.

    It is the file's project; a file in none is seen from the working directory, if it is below that.
    """
    here, path = project_root(Path.cwd()), file.resolve()
    root = _marked_above(path) or (here if path.is_relative_to(here) else project_root(path))
    return root, ".".join(path.relative_to(root).with_suffix("").parts)


def add_interfaces(root: Path) -> None:
    """Make the messages, services and actions in a project's `interfaces/` available, and those of its workspace."""
    folder = root / "interfaces"
    if folder.is_dir():
        registry.add_root(folder)
    registry.add_later(installed.interfaces)
    registry.add_later(lambda: find_workspace(root).interfaces)


def demos_root() -> Path:
    """The folder with the bundled `graphs/` and `nodes/`: inside the installed package, or the project's own."""
    return INSTALLED_DEMOS if INSTALLED_DEMOS.is_dir() else PACKAGE.parent


def bundled_graphs() -> dict[str, Path]:
    """The graphs that come with graphflow, by name: `turtlesim`, `deadlock/crossing_broken`."""
    folder = demos_root() / "graphs"
    return {f.relative_to(folder).with_suffix("").as_posix(): f for f in sorted(folder.rglob("*.yaml"))}


def no_file(path: Path) -> str:
    """What to say of a file that is not there: the one that is most like it."""
    if path.exists():
        return f"{shown(path)} is not a regular file"
    beside = {file.stem: file.name for file in path.parent.glob("*.*")}
    found = beside.get(nearest(path.stem, beside) or "")
    return f"there is no file {shown(path)}" + (f"; did you mean {found!r}?" if found else "")


def shown(path: Path) -> str:
    """A path as messages show it: relative to the working directory when it is below that."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except ValueError:
        return str(path)
