"""Check the names of a new package and of its dependencies."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from importlib.util import find_spec
from keyword import iskeyword
from pathlib import Path

from graphflow.cli import output
from graphflow.errors import UsageFault
from graphflow.names import nearest
from graphflow.workspace.executables import of_ros
from graphflow.workspace.packages import Workspace, find_workspace

_NAME = re.compile(r"[A-Za-z][\w-]*\Z")
_USUAL = re.compile(r"[a-z][a-z\d_]*\Z")
SLIP = 0.8
"""Similarity to a known package from which a name is reported as misspelt."""


def is_of_python(word: str) -> bool:
    """Whether a name is a keyword of Python or a module of its standard library."""
    return iskeyword(word) or word in sys.stdlib_module_names


def hidden_module(word: str) -> str:
    """Describe the module that a package of this name would hide, or that would hide it; empty if there is none."""
    if is_of_python(word):
        return "a module or keyword of Python's"
    found = find_spec(word)
    if found is None or found.origin is None or Path.cwd() in Path(found.origin).parents[:2]:  # it is the user's own
        return ""
    return "an installed module"


def near_name(word: str) -> str:
    """Turn an invalid name into a valid name of a package."""
    apart = re.sub(r"(?<=[a-z\d])(?=[A-Z])", "_", word.removesuffix(".py"))  # TurtleControl becomes turtle_control
    near = re.sub(r"[\W_]+", "_", apart.lower(), flags=re.ASCII).strip("_")
    return near if near.isidentifier() and not is_of_python(near) else f"my_{near or 'lab'}"


def known_dependency(word: str) -> bool:
    """Whether a word is a known package: of ROS 2, of interfaces or of the workspace."""
    from graphflow.msgs import registry

    return (
        word in (*of_ros(), "rclpy", "rclcpp", "roscpp", "rospy")
        or word in registry.packages()
        or (word in _around(Path.cwd()).packages)
    )


def check_package(name: str, folder: Path) -> None:
    """Check that the name of a new package is unique.

    Args:
        folder: Its future folder.

    Raises:
        UsageFault: It is the name of a ROS 2 package, which it would hide, or of another package of the workspace.
    """
    if name in of_ros():
        raise UsageFault(f"{name!r} is a package of ROS 2, which yours would hide; choose another name")
    workspace = _around(folder)
    other = workspace.packages.get(name)
    if other is not None and other.folder != folder.resolve():
        raise UsageFault(f"{other.folder} already is the package {name!r}; choose another name")


def check_dependencies(names: Sequence[str], folder: Path) -> None:
    """Check that dependencies are names of packages, and warn about probable misspellings.

    Raises:
        UsageFault: One cannot be the name of a package.
    """
    known = {*of_ros(), *_around(folder).packages}
    for name in names:
        if _NAME.match(name) is None:
            parts = [part for part in re.split(r"[,;\s]+", name) if part]
            way = f"; write spaces between them: --dependencies {' '.join(parts)}" if len(parts) > 1 else ""
            raise UsageFault(f"{name!r} cannot be the name of a package{way}")
        near = nearest(name, known - {name}, cutoff=SLIP) if name not in known else None
        if near is not None and re.sub(r"\d", "", near) != re.sub(r"\d", "", name):  # turtlebot4_msgs is no slip
            output.talk(f"note: the dependency {name!r} is not known here; did you mean {near!r}?")


def warn_of_name(name: str) -> None:
    """Warn if the name of a new package breaks ROS's convention, about which ROS's tools would warn (REP 144)."""
    if _USUAL.match(name) is None:
        output.talk(f"note: names of packages consist of lower-case letters, digits and _, such as {near_name(name)!r}")


def warn_of_place(folder: Path) -> None:
    """Warn if a new package is beside the folder `src` of its workspace, where it would not be found."""
    workspace = _around(folder)
    if workspace.packages and (workspace.root / "src").is_dir() and folder.resolve().parent == workspace.root:
        output.talk(f"note: packages of this workspace are looked for in src/: mv {folder} {workspace.root / 'src'}")


def _around(folder: Path) -> Workspace:
    """Find the workspace that a new folder will be in; its parents may not exist yet, either."""
    return find_workspace(next(above for above in folder.resolve().parents if above.is_dir()))
