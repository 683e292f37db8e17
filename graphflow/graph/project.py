"""Where things are: a project's root, its graph files and interfaces, and those that come with graphflow."""

from __future__ import annotations

from pathlib import Path

PACKAGE = Path(__file__).parents[1]


def project_root(path: Path) -> Path:
    """The folder that a graph file's classes are imported from.

    The nearest folder above with a `pyproject.toml` and a `graphs/` or `nodes/`, else the file's own folder.
    """
    start = path.resolve()
    for folder in [start, *start.parents]:
        if (folder / "pyproject.toml").is_file() and ((folder / "graphs").is_dir() or (folder / "nodes").is_dir()):
            return folder
    return start if start.is_dir() else start.parent


def demos_root() -> Path:
    """The folder with the bundled `graphs/` and `nodes/`: inside the installed package, or the project's own."""
    installed = PACKAGE / "demos"
    return installed if installed.is_dir() else PACKAGE.parent


def bundled_graphs() -> dict[str, Path]:
    """The graphs that come with graphflow, by name."""
    return {f.stem: f for f in sorted((demos_root() / "graphs").glob("*.yaml"))}


def shown(path: Path) -> str:
    """A path as messages show it: relative to the working directory when it is below that."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except ValueError:
        return str(path)
