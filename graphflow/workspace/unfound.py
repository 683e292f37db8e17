"""Why a package is not found that a user can see: a folder that is no package, another name, another workspace."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from graphflow.reading import found_text
from graphflow.workspace.packages import Folder, Package, Workspace, folders, workspace_around

_BUILT = ("setup.py", "CMakeLists.txt")
_NEEDED = 'to make it a package, write in it: <package format="3"><name>{name}</name></package>'


def why_no_package(name: str, workspace: Workspace) -> str | None:
    """The state of a folder of that name that is no package, with the next step; None if there is no such folder.

    Args:
        workspace: The one in which it was looked for.
    """
    for found in _candidates(name, workspace):
        said = _lack(found) if found.package is None else _renamed(found, name)
        if said is not None:
            return said
    beside = workspace.root / name
    if _source(workspace) != workspace.root and _is_package(beside):
        source = _shown(_source(workspace))
        return f"{_shown(beside)} lies beside {source}, where packages are looked for: mv {_shown(beside)} {source}"
    around = outer_workspace(workspace)
    if around is not None and name in around.packages:
        return f"the package {name!r} is in {around.root}, around this workspace, {workspace.root}: cd {around.root}"
    return None


def owners(executable: str, workspace: Workspace) -> list[str]:
    """The packages of a workspace that have an executable of that name."""
    return [package.name for package in workspace.packages.values() if package.known_as(executable) is not None]


def launching(file: str, packages: Iterable[Package]) -> str:
    """How a launch file of one of the packages is started, to stand after a sentence; empty where none has it.

    Args:
        file: Its name, perhaps with folders before it.
    """
    name = Path(file).name
    owner = next((p for p in packages if any(f.name == name for f in (p.folder / "launch").rglob("*"))), None)
    return "" if owner is None else f"; to start it: graphflow launch {owner.name} {name}"


def outer_workspace(workspace: Workspace) -> Workspace | None:
    """The workspace that a workspace lies in."""
    above = workspace.root.parent
    return None if above == workspace.root else workspace_around(above)


def no_packages(workspace: Workspace) -> list[str]:
    """Folders of a workspace that were meant as packages and are none, each with what it lacks."""
    return [said for found in folders(_source(workspace)) if _is_meant(found) and (said := _lack(found))]


def _is_package(folder: Path) -> bool:
    return next(folders(folder)).package == folder.name


def _candidates(name: str, workspace: Workspace) -> Iterator[Folder]:
    """The folders of that name: in the workspace, and those that the user is in."""
    yield from (found for found in folders(_source(workspace)) if found.path.name == name)
    here = Path.cwd()
    yield from (next(folders(path)) for path in (here, *here.parents) if path.name == name)


def _renamed(found: Folder, name: str) -> str | None:
    if found.package == name:  # of a workspace that was not read
        return None
    return f"{_shown(found.path)} is the package {found.package!r}, by the name in its package.xml; use that name"


def _lack(found: Folder) -> str | None:
    """Why a folder is no package; None if nothing in it looks like one."""
    shown, name = _shown(found.path), found.path.name
    if found.mark is not None:
        return f"{shown} is left out of the workspace, as it has a file {found.mark}; remove that to have it"
    if "package.xml" in found.files:
        return _unnamed(found.path / "package.xml", f"{shown}/package.xml", name)
    if "pyproject.toml" in found.files and any((found.path / folder).is_dir() for folder in ("nodes", "graphs")):
        return f"{shown} is a project of graphflow's, not a package of ROS 2's; to use it: cd {shown}"
    built = next((file for file in _BUILT if file in found.files), None)
    return None if built is None else f"{shown} has {built} but no package.xml; {_NEEDED.format(name=name)}"


def _unnamed(file: Path, shown: str, name: str) -> str:
    """Why a package.xml names no package."""
    from xml.parsers import expat  # only after a mistake

    try:
        expat.ParserCreate().Parse(found_text(file, "replace"), True)
    except expat.ExpatError as error:
        why = expat.ErrorString(error.code)
        return f"{shown}:{error.lineno}: it is no valid XML: {why}; is a tag not closed by </...>?"
    except OSError as error:
        return f"{shown} cannot be read: {error.strerror}"
    return f"{shown} has no <name>; {_NEEDED.format(name=name)}"


def _is_meant(found: Folder) -> bool:
    """Whether a folder without a package was made as one: other code of a workspace may have a `setup.py`, too."""
    if found.package is not None or found.mark is not None:
        return False
    return "package.xml" in found.files or (found.path / "resource" / found.path.name).is_file()


def _source(workspace: Workspace) -> Path:
    inner = workspace.root / "src"
    return inner if inner.is_dir() else workspace.root


def _shown(path: Path) -> str:
    """A path from the folder that the user is in, where it is below."""
    here = Path.cwd()
    return str(path.relative_to(here)) if path != here and path.is_relative_to(here) else str(path)
