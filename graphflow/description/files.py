"""Files of robot descriptions: URDF, those that xacro expands, and the meshes that they name."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from graphflow.description.robot import Robot
from graphflow.description.urdf import parse
from graphflow.description.xacro_errors import problem
from graphflow.errors import GraphFileError, GraphflowError, Place, Problem
from graphflow.introspect.installation import requirement
from graphflow.reading import found_text
from graphflow.system import SITE
from graphflow.workspace.executables import package_share


def read_robot(file: Path | str, arguments: Mapping[str, str] | None = None) -> tuple[Robot, str]:
    """Read a robot description; returns it, and its text in URDF.

    Args:
        file: A URDF file; one that uses xacro is expanded, whatever its ending.
        arguments: Arguments of the xacro file.

    Raises:
        GraphFileError: The file is missing or has mistakes; all of them, with their places.
        GraphflowError: xacro is not installed.
    """
    file = Path(file)
    try:
        text = found_text(file)
    except OSError as error:
        raise GraphFileError([Problem(Place(str(file)), f"cannot be read: {error.strerror}")]) from None
    except UnicodeDecodeError:
        raise GraphFileError([Problem(Place(str(file)), "cannot be read: it is not UTF-8")]) from None
    if file.suffix == ".xacro" or "<xacro:" in text:
        text = expanded(file, arguments or {})
        return parse(text, f"{file} (as xacro expands it)"), text
    return parse(text, str(file)), text


def expanded(file: Path, arguments: Mapping[str, str]) -> str:
    """Expand a xacro file to URDF.

    Raises:
        GraphFileError: xacro refuses it; the text has its reason.
        GraphflowError: xacro is not installed.
    """
    try:
        import xacro
    except ImportError:
        raise GraphflowError(f"{file.name} needs xacro: pip install {requirement('urdf')}") from None
    xacro.all_includes.clear()  # those of the file before
    try:
        with _finding_packages():
            text: str = xacro.process_file(str(file), mappings=dict(arguments)).toprettyxml(indent="  ")
    except Exception as error:  # xacro raises whatever the file's expressions raise
        read = [*xacro.all_includes, *filter(None, xacro.filestack or ())]
        raise GraphFileError([problem(error, read or [str(file)])]) from None
    return text


@contextmanager
def _finding_packages() -> Iterator[None]:
    """Let xacro's `$(find ...)` import graphflow's ament_index_python, unless ROS's is there."""
    sys.path.append(SITE)
    try:
        yield
    finally:
        sys.path.remove(SITE)


def mesh_file(uri: str, beside: Path) -> Path | None:
    """Find the file of a mesh: by `package://PACKAGE/...`, `file://...` or a path; None if there is none.

    Args:
        beside: The folder at which relative paths start, and from which workspaces are searched.
    """
    if uri.startswith("package://"):
        package, _, rest = uri.removeprefix("package://").partition("/")
        share = package_share(package, beside, os.environ)
        found = None if share is None else share / rest
    else:
        found = beside / uri.removeprefix("file://")
    return found if found is not None and found.is_file() else None
