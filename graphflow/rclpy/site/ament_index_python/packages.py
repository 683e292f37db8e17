"""Packages and their folders: those of the program's workspace, and those that are installed.

Nothing is built: a workspace package's `share` folder is its source folder, or a folder of links to its files.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from graphflow.names import did_you_mean
from graphflow.workspace.executables import package_prefix, package_share
from graphflow.workspace.package_share import share_folder
from graphflow.workspace.packages import Workspace, find_workspace
from graphflow.workspace.unfound import why_no_package


class PackageNotFoundError(KeyError):
    """No package has that name."""

    def __str__(self) -> str:
        return str(self.args[0])


def _workspace() -> Workspace:
    """Return the workspace of the program, or else of the shell's current folder."""
    program = Path(sys.argv[0] if sys.argv else "")
    found = find_workspace(program) if program.is_file() else None
    return found if found is not None and found.packages else find_workspace(Path.cwd())


def _missing(package_name: str, known: Workspace) -> PackageNotFoundError:
    why = why_no_package(package_name, known)
    more = did_you_mean(package_name, list(known.packages)) if why is None else f"; {why}"
    return PackageNotFoundError(f"package '{package_name}' not found, searching: ['{known.root}']{more}")


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """Return the folder of a package's launch files, parameters and other data.

    Raises:
        ValueError: Not a legal package name.
        PackageNotFoundError: No package has that name.
    """
    return Path(get_package_share_directory(package_name))


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """Return the share folder as text. Raises ValueError, PackageNotFoundError."""
    _check(package_name)
    workspace = _workspace()
    own = workspace.packages.get(package_name)
    folder = share_folder(own) if own is not None else package_share(package_name, workspace.root, os.environ)
    if folder is None:
        raise _missing(package_name, workspace)
    return str(folder)


def get_package_prefix(package_name: str) -> str:
    """Return the folder below which a package is installed. Raises ValueError, PackageNotFoundError."""
    _check(package_name)
    workspace = _workspace()
    own = workspace.packages.get(package_name)
    folder = own.folder if own is not None else package_prefix(package_name, workspace.root, os.environ)
    if folder is None:
        raise _missing(package_name, workspace)
    return str(folder)


def get_packages_with_prefixes() -> dict[str, str]:
    """Return the packages of the workspace, each with its folder."""
    return {name: str(package.folder) for name, package in _workspace().packages.items()}


def _check(package_name: str) -> None:
    if not package_name:
        raise ValueError("package name must not be empty")
    if not all(c.isalnum() or c in "_-" for c in package_name):
        raise ValueError(f"'{package_name}' is not a valid package name")
