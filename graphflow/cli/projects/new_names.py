"""Names of a new package, and of those that it depends on, that would be a mistake."""

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
"""How like a known package a dependency is that is told to be misspelt."""


def is_of_python(word: str) -> bool:
    """Whether Python takes a name for something else: for a word of its own, or for a module of its library."""
    return iskeyword(word) or word in sys.stdlib_module_names


def hidden_module(word: str) -> str:
    """The module that a package of such a name would hide, or that would hide it; empty for none."""
    if is_of_python(word):
        return "a name of Python's"
    found = find_spec(word)
    if found is None or found.origin is None or Path.cwd() in Path(found.origin).parents[:2]:  # the user's own
        return ""
    return "an installed module"


def near_name(word: str) -> str:
    """A name that a package can have, made of one that it cannot."""
    apart = re.sub(r"(?<=[a-z\d])(?=[A-Z])", "_", word.removesuffix(".py"))  # TurtleControl is turtle_control
    near = re.sub(r"[\W_]+", "_", apart.lower(), flags=re.ASCII).strip("_")
    return near if near.isidentifier() and not is_of_python(near) else f"my_{near or 'lab'}"


def known_dependency(word: str) -> bool:
    """Whether a word is a package that others depend on: of ROS 2, with types, or of the workspace."""
    from graphflow.msgs import registry

    return (
        word in (*of_ros(), "rclpy", "rclcpp", "roscpp", "rospy")
        or word in registry.packages()
        or (word in _around(Path.cwd()).packages)
    )


def check_package(name: str, folder: Path) -> None:
    """See that a new package has a name of its own.

    Args:
        folder: Where it is to be.

    Raises:
        UsageFault: It is one of ROS 2's, which it would hide, or of another package of the workspace.
    """
    if name in of_ros():
        raise UsageFault(f"{name!r} is a package of ROS 2, which yours would hide; choose another name")
    workspace = _around(folder)
    other = workspace.packages.get(name)
    if other is not None and other.folder != folder.resolve():
        raise UsageFault(f"{other.folder} is the package {name!r} already; choose another name")


def check_dependencies(names: Sequence[str], folder: Path) -> None:
    """See that dependencies are names of packages, and say which are probably misspelt.

    Raises:
        UsageFault: One is no name.
    """
    known = {*of_ros(), *_around(folder).packages}
    for name in names:
        if _NAME.match(name) is None:
            parts = [part for part in re.split(r"[,;\s]+", name) if part]
            way = f"; write spaces between them: --dependencies {' '.join(parts)}" if len(parts) > 1 else ""
            raise UsageFault(f"{name!r} is no name of a package{way}")
        near = nearest(name, known - {name}, cutoff=SLIP) if name not in known else None
        if near is not None and re.sub(r"\d", "", near) != re.sub(r"\d", "", name):  # nav2_msgs is not nav_msgs
            output.talk(f"note: the dependency {name!r} is not known here; did you mean {near!r}?")


def tell_name(name: str) -> None:
    """Say that the name of a new package is not written as those of ROS are, which its tools warn of (REP 144)."""
    if _USUAL.match(name) is None:
        output.talk(f"note: names of packages have lower-case letters, digits and _, as {near_name(name)!r} has")


def tell_place(folder: Path) -> None:
    """Say that a new package lies where it will not be found: beside the folder `src` that has the others."""
    workspace = _around(folder)
    if workspace.packages and (workspace.root / "src").is_dir() and folder.resolve().parent == workspace.root:
        output.talk(f"note: packages of this workspace are looked for in src/: mv {folder} {workspace.root / 'src'}")


def _around(folder: Path) -> Workspace:
    """The workspace that a new folder is in; the folder above it may be new, too."""
    return find_workspace(next(above for above in folder.resolve().parents if above.is_dir()))
