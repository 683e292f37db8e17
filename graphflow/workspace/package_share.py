"""The `share` folder that a package of a workspace would have if it were installed.

It is the package's own folder if installation keeps the places of files. If `data_files` of a `setup.py`, or
`install(...)` of a `CMakeLists.txt`, moves files, it is a folder of links, made on demand.
"""

from __future__ import annotations

import ast
import hashlib
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from glob import glob
from pathlib import Path, PurePosixPath

from graphflow.folders import state_root
from graphflow.reading import found_text, parsed
from graphflow.workspace.packages import Package, cmake_text, find_workspace
from graphflow.workspace.setup_file import constant_text, constants

FILES_BOUND = 5000
_INSTALL = re.compile(r"install\s*\(\s*(DIRECTORY|FILES|PROGRAMS)\s+(.*?)\)", re.DOTALL | re.IGNORECASE)
_END_OF_FILES = re.compile(r"\s(?:DESTINATION|PATTERN|FILES_MATCHING|USE_SOURCE_PERMISSIONS|RENAME)\s", re.IGNORECASE)


def share_folder(package: Package) -> Path:
    """Return the folder that `get_package_share_directory` returns for a package."""
    moved = {there: file for there, file in _installed(package) if file != package.folder / there}
    if not moved:
        return package.folder
    folders = sorted({str(there.parent) for there in moved})  # links and folders change places with them
    digest = hashlib.sha256("\n".join([str(package.folder), *folders]).encode()).hexdigest()[:16]
    folder = state_root() / "share" / digest / package.name
    try:
        _link(folder, package.folder, moved)
    except OSError:  # the disk is full, or this system has no links
        return package.folder
    return folder


def in_launch_file(missing: Path, launch_file: Path) -> str:
    """Return how a launch file writes the path of a file of its package that is not where it was looked for.

    Empty if the package has no such file.
    """
    packages = find_workspace(launch_file.parent).packages.values()
    package = next((one for one in packages if launch_file.resolve().is_relative_to(one.folder)), None)
    if package is None:
        return ""
    tails = ["/".join(missing.parts[-n:]) for n in range(len(missing.parts) - 1, 0, -1)]
    tails += [f"{folder}/{missing.name}" for folder in ("config", "params")]
    found = next((tail for tail in tails if (package.folder / tail).is_file()), None)
    if found is None:
        return ""
    if launch_file.suffix != ".py":
        return f"$(find-pkg-share {package.name})/{found}"
    return f"get_package_share_directory({package.name!r}) + '/{found}'"


def _installed(package: Package) -> Iterator[tuple[PurePosixPath, Path]]:
    """Yield the path of each installed file in the `share` folder, and its present path."""
    pairs = [*_of_setup_py(package), *_of_cmake(package)]
    for (destination, file), _ in zip(pairs, range(FILES_BOUND), strict=False):
        parts = PurePosixPath(destination).parts
        if parts[:2] == ("share", package.name) and file.is_file() and ".." not in parts:
            yield PurePosixPath(*parts[2:], file.name), file


def _link(folder: Path, source: Path, moved: Mapping[PurePosixPath, Path]) -> None:
    """Fill a folder with links to the entries of `source`, and to moved files at their new places."""
    inner: dict[str, dict[PurePosixPath, Path]] = {}
    for there, file in moved.items():
        if len(there.parts) > 1:
            inner.setdefault(there.parts[0], {})[PurePosixPath(*there.parts[1:])] = file
    wanted = {entry.name: entry for entry in source.iterdir()} if source.is_dir() else {}
    wanted |= {there.name: file for there, file in moved.items() if len(there.parts) == 1}
    folder.mkdir(parents=True, exist_ok=True)
    for entry in folder.iterdir():
        with suppress(FileNotFoundError):  # another process does the same
            if entry.is_symlink() and wanted.get(entry.name) != Path(os.readlink(entry)):
                entry.unlink()
    for name, target in wanted.items():
        if name not in inner and not (folder / name).is_symlink():
            with suppress(FileExistsError):
                (folder / name).symlink_to(target)
    for name, files in inner.items():
        _link(folder / name, source / name, files)


def _of_setup_py(package: Package) -> Iterator[tuple[str, Path]]:
    """Yield the destinations and files of `data_files`, as far as they are literal."""
    try:
        tree = parsed(found_text(package.folder / "setup.py", "replace"))
    except (OSError, SyntaxError, ValueError):
        return
    known = constants(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Tuple) and len(node.elts) == 2:
            destination = constant_text(node.elts[0], known)
            if destination is not None and destination.startswith("share"):
                for file in _files(node.elts[1], known, package.folder):
                    yield destination, package.folder / file


def _files(node: ast.expr, known: Mapping[str, str], folder: Path) -> list[str]:
    """Return the files of a list or pattern, relative to the package's folder."""
    match node:
        case ast.List(elts=parts) | ast.Tuple(elts=parts):
            return [text for part in parts if (text := constant_text(part, known)) is not None]
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _files(left, known, folder) + _files(right, known, folder)
        case ast.Call(func=ast.Name(id="glob") | ast.Attribute(attr="glob"), args=[pattern, *_]):
            text = constant_text(pattern, known)
            return [] if text is None else sorted(glob(text, root_dir=folder, recursive=True))
    return []


def _of_cmake(package: Package) -> Iterator[tuple[str, Path]]:
    for kind, words in _INSTALL.findall(cmake_text(package)):
        destination = re.search(r"DESTINATION\s+\"?([^\s\")]+)", words, re.IGNORECASE)
        if destination is None:
            continue
        there = destination[1]
        for word in _END_OF_FILES.split(f"{words} ")[0].replace('"', " ").split():
            source = package.folder / word
            if kind.upper() != "DIRECTORY":
                yield there, source
                continue
            base = source if word.endswith("/") else source.parent
            for file in sorted(source.rglob("*")):
                yield str(PurePosixPath(there, *file.relative_to(base).parent.parts)), file
