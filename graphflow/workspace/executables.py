"""Executables by package and name: bundled nodes, and those of projects, workspaces and distributions."""

from __future__ import annotations

import ast
import os
import re
import shutil
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from importlib import util
from pathlib import Path
from typing import NamedTuple

from graphflow.msgs import registry
from graphflow.names import did_you_mean, nearest
from graphflow.reading import found_text
from graphflow.system import ROS2, SITE
from graphflow.workspace.installed import GROUP, Installed, installed, package_of
from graphflow.workspace.node_classes import sole_class_in
from graphflow.workspace.package_share import share_folder
from graphflow.workspace.packages import Package, Workspace, bundled, find_workspace
from graphflow.workspace.source_kinds import uses_ros
from graphflow.workspace.unfound import why_no_package, without_executables

EXECUTABLES = {
    ("turtlesim", "turtlesim_node"): "nodes.turtlesim:TurtleSim",
    ("turtlesim", "turtle_teleop_key"): "nodes.turtle_teleop:TurtleTeleop",
    ("turtlesim", "mimic"): "nodes.mimic:Mimic",
    ("turtlesim", "draw_square"): "nodes.draw_square:DrawSquare",
    ("demo_nodes_cpp", "talker"): "nodes.talker:Talker",
    ("demo_nodes_cpp", "listener"): "nodes.listener:Listener",
    ("demo_nodes_py", "talker"): "nodes.talker:Talker",
    ("demo_nodes_py", "listener"): "nodes.listener:Listener",
    ("demo_nodes_cpp", "add_two_ints_server"): "nodes.add_two_ints_server:AddTwoIntsServer",
    ("demo_nodes_py", "add_two_ints_server"): "nodes.add_two_ints_server:AddTwoIntsServer",
    ("composition", "talker"): "nodes.talker:Talker",
    ("composition", "listener"): "nodes.listener:Listener",
    ("turtle_tf2_py", "turtle_tf2_broadcaster"): "nodes.turtle_tf_broadcaster:TurtleTfBroadcaster",
    ("turtle_tf2_py", "turtle_tf2_listener"): "nodes.turtle_tf_listener:TurtleTfListener",
    ("turtle_tf2_py", "fixed_frame_tf2_broadcaster"): "nodes.carrot_broadcaster:CarrotBroadcaster",
    ("turtlebot3_gazebo", "simulator"): "nodes.robot_simulator:RobotSimulator",
    ("turtlebot3_teleop", "teleop_keyboard"): "nodes.robot_teleop:RobotTeleop",
    ("robot_state_publisher", "robot_state_publisher"): "nodes.robot_state_publisher:RobotStatePublisher",
    ("joint_state_publisher", "joint_state_publisher"): "nodes.joint_state_publisher:JointStatePublisher",
    ("nav2_map_server", "map_server"): "nodes.map_server:MapServer",
    ("slam_toolbox", "async_slam_toolbox_node"): "nodes.mapper:Mapper",
    ("slam_toolbox", "sync_slam_toolbox_node"): "nodes.mapper:Mapper",
    ("cartographer_ros", "cartographer_node"): "nodes.mapper:Mapper",
    ("teleop_twist_keyboard", "teleop_twist_keyboard"): "nodes.twist_teleop:TwistTeleop",
    ("aro_reactive_control", "reactive_control"): "nodes.reactive_control:EventDriven",
    ("joint_state_publisher_gui", "joint_state_publisher_gui"): "nodes.joint_state_publisher:JointStatePublisher",
    ("lifecycle", "lifecycle_talker"): "nodes.lifecycle_talker:LifecycleTalker",
    ("lifecycle", "lifecycle_listener"): "nodes.lifecycle_listener:LifecycleListener",
    ("lifecycle_py", "lifecycle_talker"): "nodes.lifecycle_talker:LifecycleTalker",
}
"""Executables of ROS 2's packages with nodes bundled with graphflow."""
_NAMES = {"turtlesim_node": "turtlesim", "turtle_teleop_key": "teleop_turtle", "mimic": "turtle_mimic"} | {
    "lifecycle_talker": "lc_talker",
    "lifecycle_listener": "lc_listener",
    "joint_state_publisher_gui": "joint_state_publisher",
}
"""Names of nodes that differ from those of their executables."""
_ALWAYS_ACTIVE = ("slam_toolbox", "nav2_map_server")
"""Packages whose nodes have a life cycle in ROS, and none here."""
_PACKAGE_NAME = re.compile(r"<name>\s*([\w-]+)\s*</name>")
SLIP = 0.7
"""Similarity, from 0 to 1, from which a name counts as a misspelling of another."""
_SEARCH_DEPTH = 4
"""Depth in folders of the search for packages below a project's root."""


class Executable(NamedTuple):
    """A node class with the default name of its node."""

    class_path: str
    node_name: str
    is_always_active: bool = False
    """Whether it has no life cycle, though ROS's has one."""


def find(package: str, executable: str, root: Path) -> Executable | None:
    """Find the node class of an executable; None if there is none of that name.

    Args:
        root: The project's folder. A module `nodes/EXECUTABLE.py` with one class is an executable of the package with
            the project's name, and so is an entry of `console_scripts` in its `setup.py`. Installed distributions are
            searched last.
    """
    if (package, executable) in EXECUTABLES:
        name = _NAMES.get(executable, executable)
        return Executable(EXECUTABLES[package, executable], name, package in _ALWAYS_ACTIVE)
    module = _scripts(package, root).get(executable)
    if module is None and package in (root.name, _project_name(root)):
        module = f"nodes.{executable}"
    file = root / f"{module.replace('.', '/')}.py" if module is not None else None
    sole = sole_class_in(file) if file is not None and file.is_file() and not uses_ros(file) else None
    if sole is not None:
        return Executable(f"{module}:{sole}", executable)
    outside = package_of(package)
    nodes = dict(outside.nodes) if outside is not None else {}
    if package in (root.name, _project_name(root)):
        nodes |= project_nodes(root)
    return Executable(nodes[executable], executable) if executable in nodes else None


def spelling_fault(package: Package, executable: str) -> str | None:
    """Return the fault of an executable's name that works here, and not in ROS 2."""
    known = package.known_as(executable)
    is_other = known in package.entry_points and known != executable
    return f"the executable is called {known}; ROS 2 finds no {executable}" if is_other else None


def as_name(executable: str) -> str:
    """Convert the name of an executable, or of a file, to a node's name."""
    return re.sub(r"[\W_]+", "_", Path(executable).name.removesuffix(".py")).strip("_") or "program"


class NoExecutable(LookupError):
    """No executable has the name.

    Attributes:
        is_slip: Whether a name is misspelt, or the package is faulty; else the executable may be installed elsewhere.
    """

    def __init__(self, text: str, *, is_slip: bool) -> None:
        super().__init__(text)
        self.is_slip = is_slip


def command_of(package: str, name: str, workspace: Workspace, env: Mapping[str, str]) -> tuple[str, ...]:
    """Return the command line of an executable that is no class: of a workspace, a distribution, or ROS 2.

    Args:
        env: The environment.

    Raises:
        NoExecutable: There is none of that name; the text lists those that exist.
    """
    own = workspace.packages.get(package)
    outside = package_of(package) if own is None else None
    if outside is not None and name in outside.programs:
        return ("graphflow", "run", package, name)
    if own is None and is_ros_sourced(env):
        return ("ros2", "run", package, name)
    if own is None:
        own = bundled().packages.get(package)
        with_us = [name for at, name in with_graphflow() if at == package]
        if own is None or own.known_as(name) is None:
            with_us += outside.executables if outside is not None else []
            raise _not_with_us(package, name, with_us, workspace)
    known = own.known_as(name)
    if known is None:
        if name in own.compiled:
            text = f"{name} of the package {package!r} is C++, which only colcon builds; graphflow runs Python"
            raise NoExecutable(text, is_slip=False)
        if not own.executables:
            text = f"the package {package!r} has no executable that graphflow can run{without_executables(own)}"
            raise NoExecutable(text, is_slip=bool(own.why_no_executable))
        near = own.missing_entry(name) or did_you_mean(name, own.executables)
        near = near or f"; there is {', '.join(own.executables)}"
        if name.removesuffix(".py") in own.why_no_executable:  # which explains it
            near = ""
        near += own.why_no_executable + workspace.way_to_double(package)
        raise NoExecutable(f"the package {package!r} has no executable {name!r}{near}", is_slip=True)
    fault = own.fault_of(known)
    if fault is not None:
        raise NoExecutable(fault, is_slip=True)
    return ("graphflow", "run", str(own.folder), known)


def is_ros_sourced(env: Mapping[str, str]) -> bool:
    """Return whether a ROS 2 is sourced: a program `ros2` that is not graphflow's own."""
    found = shutil.which("ros2", path=env.get("PATH"))
    return found is not None and os.path.dirname(found) != ROS2


def _not_with_us(package: str, name: str, with_us: Sequence[str], workspace: Workspace) -> NoExecutable:
    """Return the error for an executable that neither the workspace nor graphflow has.

    Args:
        with_us: The bundled executables of its package.
    """
    if with_us:
        text = f"the package {package!r} has no executable {name!r} here{did_you_mean(name, with_us)}"
        return NoExecutable(text, is_slip=_is_slip_of(name, nearest(name, with_us)))
    why = why_no_package(package, workspace)
    if why is not None:
        return NoExecutable(why, is_slip=True)
    known = [*workspace.packages, *(package for package, _ in with_graphflow())]
    near = did_you_mean(package, (), hidden=known)
    text = f"there is no package {package!r} in {workspace.root}, and no ROS 2 is sourced{near}"
    return NoExecutable(text, is_slip=_is_slip_of(package, nearest(package, known, cutoff=SLIP)))


def _is_slip_of(name: str, meant: str | None) -> bool:
    """Return whether a name is a misspelling of another; much longer ones are names of something else."""
    return meant is not None and abs(len(meant) - len(name)) <= 2


def with_graphflow() -> list[tuple[str, str]]:
    """Return the bundled executables, each after its package."""
    programs = [(own.name, name.removesuffix(".py")) for own in bundled().packages.values() for name in own.executables]
    return [*EXECUTABLES, *programs]


def of_ros() -> set[str]:
    """Return the packages of ROS 2 that graphflow provides in some form: messages, modules or executables."""
    messages = {f.name for f in registry.BUNDLED.iterdir() if any((f / kind).is_dir() for kind in registry.KINDS)}
    return messages | {*os.listdir(SITE), *(package for package, _ in with_graphflow())}


class Listed(NamedTuple):
    """An executable in a listing."""

    package: str
    name: str
    class_path: str
    """The module, relative to the project, with the class or function."""


def all_executables(root: Path) -> list[Listed]:
    """List all executables: bundled ones, and those of the project, its workspace and installed distributions.

    Args:
        root: The project's folder.
    """
    rows = [Listed(package, name, path) for (package, name), path in EXECUTABLES.items()]
    for package in project_packages(root):
        names = {f.stem for f in (root / "nodes").glob("*.py")} | _scripts(package, root).keys()
        names |= project_nodes(root).keys()
        found = {name: find(package, name, root) for name in names}
        rows += [Listed(package, name, one.class_path) for name, one in found.items() if one is not None]
    known = {row[:2] for row in rows}
    for own in [*find_workspace(root).packages.values(), *bundled().packages.values()]:
        for name in own.executables:
            if (own.name, name) not in known:
                rows.append(Listed(own.name, name, own.path_of(name, root)))
    rows += [row for one in installed().values() for row in _rows_of(one) if row[:2] not in known]
    return sorted(set(rows))


def _rows_of(one: Installed) -> list[Listed]:
    rows = [Listed(one.name, name, class_path) for name, class_path in one.nodes.items()]
    return rows + [Listed(one.name, name, f"{e.module}:{e.function}") for name, (_, e) in one.programs.items()]


def project_packages(root: Path) -> list[str]:
    """Return the packages of a project: those with a `package.xml`, and the project itself if it has nodes."""
    own = _project_name(root) or root.name
    found = [name for name, _ in _described_packages(root)]
    return sorted({*found, *([own] if (root / "nodes").is_dir() or project_nodes(root) else [])})


def package_folder(package: str, root: Path) -> Path | None:
    """Find the folder of a package: by `package.xml` in the project or its workspace, or the project itself."""
    found = next((folder for name, folder in _described_packages(root) if name == package), None)
    if found is not None:
        return found
    if package in (root.name, _project_name(root)):
        return root
    beside = find_workspace(root).packages.get(package)
    return None if beside is None else beside.folder


def _described_packages(root: Path) -> Iterator[tuple[str, Path]]:
    """Yield the names and folders of packages with a `package.xml`; folders may disappear meanwhile."""
    for folder, folders, files in os.walk(root):
        depth = len(Path(folder).relative_to(root).parts)
        folders[:] = sorted(f for f in folders if not f.startswith(".")) if depth < _SEARCH_DEPTH - 1 else []
        if "package.xml" in files:
            try:
                text = found_text(Path(folder, "package.xml"), "replace")
            except OSError:
                continue
            name = _PACKAGE_NAME.search(text)
            if name:
                yield name[1], Path(folder)


def package_share(package: str, root: Path, env: Mapping[str, str]) -> Path | None:
    """Find the `share` folder of a package: of the project, of a sourced ROS 2, or of an installed Python package.

    Args:
        root: The project's folder.
        env: The environment.
    """
    own, sourced = package_folder(package, root), _sourced(package, env)
    if own is not None:
        return share_folder(Package(package, own))
    return sourced / "share" / package if sourced else _python_package(package) or _bundled_folder(package)


def package_prefix(package: str, root: Path, env: Mapping[str, str]) -> Path | None:
    """Find the prefix under which a package is installed. Arguments as for `package_share`."""
    own, sourced = package_folder(package, root), _sourced(package, env)
    return own or sourced or (Path(sys.prefix) if _python_package(package) else _bundled_folder(package))


def package_program(program: str, package: str, root: Path, env: Mapping[str, str]) -> Path | None:
    """Find a program of a package: installed, in its `scripts`, or beside this Python. Arguments as for `find`."""
    own, sourced = package_folder(package, root), _sourced(package, env)
    folders = [own / "scripts", own / package, own] if own else []
    folders += [sourced / "lib" / package] if sourced else []
    folders += [Path(sys.prefix) / "bin"]
    found = shutil.which(program, path=os.pathsep.join(map(str, folders)))
    return Path(found) if found else None


def _sourced(package: str, env: Mapping[str, str]) -> Path | None:
    """Find the prefix of a package in a sourced ROS 2."""
    prefixes = [Path(p) for p in env.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    index = Path("share/ament_index/resource_index/packages")
    return next((prefix for prefix in prefixes if (prefix / index / package).is_file()), None)


def _python_package(name: str) -> Path | None:
    """Find the folder of an installed Python package."""
    try:
        spec = util.find_spec(name) if name.isidentifier() else None
    except ValueError:  # a module without a spec, such as __main__
        spec = None
    folders = list(spec.submodule_search_locations or []) if spec else []
    return Path(folders[0]) if folders else None


def _bundled_folder(package: str) -> Path | None:
    own = bundled().packages.get(package)
    return None if own is None else own.folder


def _scripts(package: str, root: Path) -> dict[str, str]:
    """Return the modules of a package's executables by name, from `console_scripts` in its `setup.py`."""
    folder = package_folder(package, root)
    if folder is None or folder != root or not (root / "setup.py").is_file():
        return {}  # only modules below the root can be imported
    found = {}
    for node in ast.walk(_parsed(root / "setup.py")):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            script = re.fullmatch(r"\s*([\w.-]+)\s*=\s*([\w.]+):\w+\s*", node.value)
            if script:
                found[script[1]] = script[2]
    return found


def project_nodes(root: Path) -> dict[str, str]:
    """Return the class paths of the node entry points in a project's `pyproject.toml`, by executable."""
    points = _project(root).get("entry-points", {})
    nodes = points.get(GROUP, {}) if isinstance(points, dict) else {}
    return {str(name): str(path) for name, path in nodes.items()} if isinstance(nodes, dict) else {}


def _project_name(root: Path) -> str:
    return str(_project(root).get("name", ""))


def _project(root: Path) -> dict[str, object]:
    try:
        found = tomllib.loads(found_text(root / "pyproject.toml")).get("project")
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}


def _parsed(file: Path) -> ast.Module:
    try:
        return ast.parse(found_text(file))
    except (OSError, SyntaxError, ValueError):
        return ast.Module([], [])
