"""Reasons why a package is not found: its folder is no package, has another name, or is in another workspace."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from graphflow.reading import found_text
from graphflow.workspace.packages import Folder, Package, Workspace, cmake_text, folders, workspace_around

_BUILT = ("setup.py", "CMakeLists.txt")
_SHARED = ("launch", "config", "params", "urdf", "rviz", "worlds", "maps", "meshes")
"""Folders of a package that launch files read after the build."""
_COMPUTES = re.compile(r"\b(iterdir|walk|rglob|listdir|scandir)\(")
"""Calls by which a `setup.py` may find its folders itself."""
_LISTED = 4
"""Files that a line lists."""
_LAUNCH_FILES = (".py", ".xml", ".yaml", ".yml")
_NEEDED = 'to make it a package, write in it: <package format="3"><name>{name}</name></package>'


def why_no_package(name: str, workspace: Workspace) -> str | None:
    """Return why a folder of a package's name is not found as a package, with the next step; None if there is none.

    Args:
        workspace: The workspace that was searched.
    """
    for found in _candidates(name, workspace):
        reason = _lack(found) if found.package is None else _renamed(found, name)
        if reason is not None:
            return reason
    source = _source(workspace)
    beside = (source.parent if source.name == "src" else source) / name
    if source.name == "src" and _is_package(beside):
        there = _shown(source)
        return f"{_shown(beside)} lies beside {there}, where packages are looked for: mv {_shown(beside)} {there}"
    around = outer_workspace(workspace)
    if around is not None and name in around.packages:
        return f"the package {name!r} is in {around.root}, around this workspace, {workspace.root}: cd {around.root}"
    return None


def without_executables(package: Package) -> str:
    """Return why a package has no executables, or else how it gets one, as the end of a message; or empty."""
    setup = package.folder / "setup.py"
    if package.why_no_executable or not setup.is_file():
        return package.why_no_executable
    return f"; write a module in {package.folder / package.name}, and name its function in console_scripts of {setup}"


def owners(executable: str, workspace: Workspace) -> list[str]:
    """Return the packages of a workspace that have an executable."""
    return [package.name for package in workspace.packages.values() if package.known_as(executable) is not None]


def launching(file: str, packages: Iterable[Package]) -> str:
    """Return the command that starts a launch file of one of the packages, as the end of a message; or empty.

    Args:
        file: The name of the launch file, perhaps after folders.
    """
    name = Path(file).name
    owner = next((p for p in packages if any(f.name == name for f in (p.folder / "launch").rglob("*"))), None)
    return "" if owner is None else f"; to start it: graphflow launch {owner.name} {name}"


def starts_of(package: Package) -> str:
    """Return the commands that start something of a package, as the end of a message; or empty."""
    folder = package.folder / "launch"
    files = sorted(file.name for file in folder.rglob("*") if file.suffix in _LAUNCH_FILES)
    starts = [f"graphflow launch {package.name} {file}" for file in files[:1]]
    starts += [f"graphflow run {package.name} {executable}" for executable in package.executables[:1]]
    return "; to start it: " + ", or ".join(starts) if starts else ""


def uninstalled_files(package: Package) -> str:
    """Return what a package's build lacks for ROS 2 to find its launch files and the like; "" if it installs them."""
    setup, cmake = package.folder / "setup.py", package.folder / "CMakeLists.txt"
    file, known = (setup, package.setup.text) if setup.is_file() else (cmake, cmake_text(package))
    if not file.is_file():
        return ""
    for folder in _SHARED:
        files = sorted(one.name for one in (package.folder / folder).glob("*") if one.is_file())
        if not files or re.search(rf"\b{folder}\b", known):
            continue
        text = f"{_shown(file)} does not install {folder}/, so that ROS 2 would not find it; add"
        if file == cmake:
            return f"{text}: install(DIRECTORY {folder} DESTINATION share/${{PROJECT_NAME}})"
        if _COMPUTES.search(known):
            continue
        place = f"'share/{package.name}/{folder}'"
        if len(files) > _LISTED:
            line = f"({place}, glob('{folder}/*')),"
            if "from glob import glob" in known:
                return f"{text} to data_files: {line}"
            return f"{text} from glob import glob at the top, and to data_files: {line}"
        return f"{text} to data_files: ({place}, [{', '.join(repr(f'{folder}/{name}') for name in files)}]),"
    return ""


def inner_workspaces(workspace: Workspace) -> list[Path]:
    """Return the folders within a workspace that are workspaces themselves, as their packages lie in a `src`."""
    found: dict[Path, None] = {}
    for package in workspace.packages.values():
        inside = package.folder.relative_to(workspace.root)
        inner = [workspace.root / above.parent for above in inside.parents if above.name == "src"]
        found.update((folder, None) for folder in inner if folder != workspace.root)
    return [*found]


def outer_workspace(workspace: Workspace) -> Workspace | None:
    """Return the workspace around a workspace."""
    above = workspace.root.parent
    return None if above == workspace.root else workspace_around(above)


def no_packages(workspace: Workspace, *, setup_is_enough: bool = False) -> list[str]:
    """Return the faults of folders that are meant as packages and are none.

    Args:
        setup_is_enough: Whether a `setup.py` alone shows that a package is meant.
    """
    meant = [
        one for one in folders(_source(workspace)) if _is_intended(one) or (setup_is_enough and one.package is None)
    ]
    return [fault for found in meant if (fault := _lack(found))]


def _is_package(folder: Path) -> bool:
    return next(folders(folder)).package == folder.name


def _candidates(name: str, workspace: Workspace) -> Iterator[Folder]:
    """Yield the folders of a name: in the workspace, and among those around the working directory."""
    yield from (found for found in folders(_source(workspace)) if found.path.name == name)
    here = Path.cwd()
    yield from (next(folders(path)) for path in (here, *here.parents) if path.name == name)


def _renamed(found: Folder, name: str) -> str | None:
    if found.package == name:  # it is in another workspace
        return None
    from graphflow.workspace.manifest import name_fault  # with an XML parser, only after a mistake

    if name_fault(found.path, name) is None and name_fault(found.path, str(found.package)) is not None:
        file = _shown(found.path / "package.xml")
        return f"{file} has the name {found.package!r}, and setup.py beside it {name!r}: write <name>{name}</name>"
    return f"{_shown(found.path)} is the package {found.package!r}, by the name in its package.xml; use that name"


def _lack(found: Folder) -> str | None:
    """Return why a folder is no package; None if nothing in it resembles one."""
    shown, name = _shown(found.path), found.path.name
    if found.mark is not None:
        return f"{shown} is left out of the workspace, as it has a file {found.mark}; remove that to have it"
    if "package.xml" in found.files:
        return _unnamed(found.path / "package.xml", f"{shown}/package.xml", name)
    if "pyproject.toml" in found.files and any((found.path / folder).is_dir() for folder in ("nodes", "graphs")):
        command = f"graphflow pkg create --build-type ament_python {name}"
        made = f"a package is made, once {shown} has another name, by {command}, in {_shown(found.path.parent)}"
        return f"{shown} is a project of graphflow's, not a package of ROS 2's; to use it: cd {shown}; {made}"
    built = next((file for file in _BUILT if file in found.files), None)
    return None if built is None else f"{shown} has {built} but no package.xml; {_NEEDED.format(name=name)}"


def _unnamed(file: Path, shown: str, name: str) -> str:
    """Return why a package.xml has no name."""
    from xml.parsers import expat  # only after a mistake

    try:
        expat.ParserCreate().Parse(found_text(file, "replace"), True)
    except expat.ExpatError as error:
        why = expat.ErrorString(error.code)
        return f"{shown}:{error.lineno}: it is not valid XML: {why}; is a tag not closed by </...>?"
    except OSError as error:
        return f"{shown} cannot be read: {error.strerror}"
    return f"{shown} has no <name>; {_NEEDED.format(name=name)}"


def _is_intended(found: Folder) -> bool:
    """Return whether a folder is meant as a package; a `setup.py` alone does not show it."""
    if found.package is not None or found.mark is not None:
        return False
    return "package.xml" in found.files or (found.path / "resource" / found.path.name).is_file()


def _source(workspace: Workspace) -> Path:
    inner = workspace.root / "src"
    return inner if inner.is_dir() else workspace.root


def _shown(path: Path) -> str:
    """Return a path relative to the working directory, if it is below."""
    here = Path.cwd()
    return str(path.relative_to(here)) if path != here and path.is_relative_to(here) else str(path)
