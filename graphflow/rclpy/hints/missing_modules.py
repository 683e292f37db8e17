"""Next steps for modules that are not found: another package of the workspace has them, or PyPI."""

from __future__ import annotations

import linecache
import os
import re
import sys
from pathlib import Path
from pkgutil import iter_modules
from traceback import walk_tb
from types import FrameType, ModuleType

from graphflow.msgs import registry
from graphflow.names import nearest
from graphflow.rclpy.hints.frames import own
from graphflow.system import SITE
from graphflow.workspace.executables import SLIP, of_ros
from graphflow.workspace.packages import KINDS, Package, Workspace, find_workspace


def missing_module(error: BaseException, frames: list[FrameType]) -> str:
    """Suggest where to get a module that the program imports."""
    if not isinstance(error, ModuleNotFoundError) or error.name is None:
        return ""
    if not str(error).startswith("No module named"):  # its text has the next step
        return ""
    files = [Path(frame.f_code.co_filename) for frame in own(frames)[-1:]]
    found = [find_workspace(place) for place in (*files, Path.cwd())]
    workspace = next((one for one in found if one.packages), found[-1])
    return where_to_have(error.name, workspace, imported_in(error))


def imported_in(error: BaseException) -> str:
    """Return the first name that the failing line imports; empty if the line has another form."""
    parts = list(walk_tb(error.__traceback__))
    line = linecache.getline(parts[-1][0].f_code.co_filename, parts[-1][1]) if parts else ""
    found = re.match(r"\s*from\s+[\w.]+\s+import\s+\(?\s*(\w+)", line)
    return found[1] if found is not None else ""


def where_to_have(module: str, workspace: Workspace, wanted: str = "") -> str:
    """Suggest where to get a missing module.

    Args:
        wanted: The name imported from it; empty if unknown.
    """
    name = module.partition(".")[0]
    package = workspace.packages.get(name)
    if package is not None:
        return _not_in_package(package, module, workspace, wanted)
    imported = sys.modules.get(name)
    if imported is not None:
        return _no_module_in(imported, module)
    owner = next((p for p in workspace.packages.values() if _has_module(p, name)), None)
    if owner is not None:
        return f"{name}.py is in the package {owner.name}; write: from {owner.name}.{module} import ..."
    if name in ("rospy", "roscpp", "roslib"):
        return f"{name} is ROS 1's: in ROS 2 a program imports rclpy, and has a class that derives from rclpy.node.Node"
    if name in _INSTEAD:
        return f"there is no {name} here: {_INSTEAD[name]}"
    if name in _ON_PYPI:
        return f"there is no {name} here: pip install {_ON_PYPI[name]}"
    near = nearest(name, [*workspace.packages, *registry.packages(), *os.listdir(SITE)], cutoff=SLIP)
    meant = f"; did you mean {near!r}?" if near is not None else ""
    into = f"clone its package beside those below {workspace.root}" if workspace.packages else "clone its package"
    if name.endswith(("_msgs", "_interfaces", "_srvs", "_actions")):
        return f"there is no {name} here: {into}{meant}"
    return f"there is no {name} here{meant or f': {into} if it is a ROS package, or pip install it if it is on PyPI'}"


def _not_in_package(package: Package, module: str, workspace: Workspace, wanted: str) -> str:
    """Suggest where to get a module that a package of the workspace lacks."""
    name, _, kind = module.partition(".")
    if name in of_ros():
        return f"your package {package.folder} hides ROS 2's {name}; rename yours, there and in its files"
    for file, right in package.misplaced_interfaces.items():
        if right.suffix == f".{kind}" or module == name:
            return f"{file} must be {right}"
    if module == name:
        return f"{package.folder} has neither Python modules of that name nor .msg, .srv or .action files"
    if kind not in KINDS:
        return f"{name} has no module {module}; the package is {package.folder}"
    others = [p.name for p in workspace.packages.values() if p.has_kind(kind)]
    owners = [other for other in others if wanted in registry.names_in(other, kind)]
    if owners:
        return f"{wanted} is in {owners[0]}.{kind}: from {owners[0]}.{kind} import {wanted}"
    own = next((one for one in KINDS if wanted in registry.names_in(name, one)), None)
    if own is not None:
        return f"{wanted} is in {name}.{own}: from {name}.{own} import {wanted}"
    near = nearest(name, others, cutoff=SLIP) or next((o for o in others if o.startswith(name)), None)
    if near is not None:
        return f"{name} has no .{kind} file; they are in {near}: from {near}.{kind} import ..."
    return f"{name} has no .{kind} file: {package.folder / kind} does not exist or is empty"


def _no_module_in(package: ModuleType, module: str) -> str:
    """Suggest the next step where a package exists but lacks the module that is imported from it."""
    file = getattr(package, "__file__", None)
    folders = getattr(package, "__path__", None)
    owner, _, word = module.rpartition(".")
    if folders is None and word != "py":
        return f"{file or package.__name__} is a module, not a package"
    if word == "py":
        return f"modules are imported without .py: write import {owner}"
    above, _, kind = owner.rpartition(".")
    if kind in KINDS and above in registry.packages() and word in registry.names_in(above, kind):
        return f"{word} is a class, not a module: write from {owner} import {word}"
    known = {found.name for found in iter_modules(folders)}
    if package.__name__ in registry.packages():
        known |= {kind for kind in KINDS if registry.names_in(package.__name__, kind)}
    near = nearest(word.lower(), known)
    meant = f"; did you mean '{module.rpartition('.')[0]}.{near}'?" if near is not None else ""
    return f"there is no module {module}{meant}"


def _has_module(package: Package, name: str) -> bool:
    return any((package.folder / part / f"{name}.py").is_file() for part in (package.name, f"src/{package.name}"))


_INSTEAD = {
    "rosbag2_py": "graphflow.bag.read(...) yields the messages of a bag, and `graphflow bag` has ros2 bag's verbs",
}
"""Replacements of packages that graphflow does not have."""
_ON_PYPI = {
    "serial": "pyserial",
    "cv2": "opencv-python",
    "PIL": "pillow",
    "skimage": "scikit-image",
    "sklearn": "scikit-learn",
    "board": "adafruit-blinka",
    "usb": "pyusb",
    "transforms3d": "transforms3d",
    "scipy": "scipy",
    "matplotlib": "matplotlib",
    "pygame": "pygame",
    "xacro": "xacro",
}
"""The PyPI packages of modules that robot programs often import."""
