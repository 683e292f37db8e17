"""ROS 2 workspaces, read without building them: the packages below a folder, and what each has to be run.

What a package installs is read from its `setup.py`, `setup.cfg` or `CMakeLists.txt`, without running any of them.
"""

from __future__ import annotations

import ast
import configparser
import os
import re
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from graphflow.folders import home
from graphflow.names import did_you_mean
from graphflow.reading import found_text
from graphflow.system import SITE

DEPTH = 5
"""Folders below a workspace in which packages are looked for."""
FOLDERS_BOUND = 5000
"""Folders that are looked into: the shell may stand in any folder, be it `/`."""
PACKAGES_BOUND = 1000
_VALUE_BOUND = 10_000
"""Characters that a variable of CMake may stand for."""
_LEFT_OUT = {"build", "install", "log", "node_modules", "__pycache__", "venv"}
"""Folders that colcon makes, and others in which no package lies."""
_MARKS = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
"""Files that say that nothing below is a package."""
_NAME = re.compile(r"<name>\s*([\w-]+)\s*</name>")
_SCRIPT = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*:\s*([\w.]+)\s*")
_INSTALL = re.compile(r"install\s*\(\s*(?:PROGRAMS|FILES)\s+(.*?)\)", re.DOTALL | re.IGNORECASE)
_COMPILED = re.compile(r"add_executable\s*\(\s*([\w${}-]+)", re.IGNORECASE)
_SET = re.compile(r"\bset\s*\(\s*(\w+)\s+([^()]+?)\s*\)", re.IGNORECASE)
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_MODULES = re.compile(r"ament_python_install_package\s*\(\s*([\w${}-]+)(?:\s+PACKAGE_DIR\s+([^\s)]+))?", re.IGNORECASE)
KINDS = ("msg", "srv", "action")
_ROS = ("rclpy", "launch", "launch_ros")
"""Packages of ROS's that a program of ROS's imports one of."""
BUNDLED = Path(__file__).parents[1] / "rclpy" / "packages"
"""The packages with programs of ROS 2's that come with graphflow; they lie there as in any workspace."""


class EntryPoint(NamedTuple):
    """A function of a module that is an executable."""

    module: str
    function: str


@dataclass(frozen=True)
class Package:
    """A package of a workspace."""

    name: str
    folder: Path

    @property
    def import_roots(self) -> list[Path]:
        """The folders that Python imports from: of a package of its name or that CMake installs, of executables."""
        folders = {self.folder / self.name, self.python_folder / self.name}
        for name, folder in _MODULES.findall(cmake_text(self)):
            folders.add(self.folder / (folder or name).strip('"'))
        roots = {folder.parent for folder in folders if next(folder.glob("*.py"), None) is not None}
        if any(self.file_of(entry).is_file() for entry in self.entry_points.values()):
            roots.add(self.python_folder)
        return sorted(roots)

    @cached_property
    def python_folder(self) -> Path:
        """Where its modules begin: its folder, unless `setup.py` says `package_dir={"": "src"}`."""
        return self.folder / _package_dir(self.folder / "setup.py")

    @property
    def has_interfaces(self) -> bool:
        """Whether messages, services or actions are defined in it."""
        return any(next((self.folder / kind).rglob(f"*.{kind}"), None) is not None for kind in KINDS)

    @cached_property
    def entry_points(self) -> Mapping[str, EntryPoint]:
        """Its executables that are functions, by name."""
        return {**_of_setup_py(self.folder / "setup.py"), **_of_setup_cfg(self.folder / "setup.cfg")}

    @cached_property
    def programs(self) -> Mapping[str, Path]:
        """Its executables that are files, by name: those that CMake installs, and those in `scripts/`."""
        files = (file for file in sorted((self.folder / "scripts").glob("*")) if file.is_file())
        known = {file.name: file for file in files if file.name != "__init__.py" and not file.name.startswith(".")}
        return known | dict(_of_cmake(self))

    @property
    def executables(self) -> list[str]:
        """The names of all."""
        return sorted({*self.entry_points, *self.programs})

    @property
    def compiled(self) -> set[str]:
        """The executables that only a compiler makes."""
        return {*_COMPILED.findall(cmake_text(self))}

    @property
    def faults(self) -> list[str]:
        """What is wrong with its executables."""
        found = [fault for name in self.entry_points if (fault := self.fault_of(name)) is not None]
        setup = self.folder / "setup.py"
        if _computes_scripts(setup):
            found.append(
                f"{setup}: it computes some executables, and is only read; run their files: graphflow run FILE"
            )
        return found

    def fault_of(self, executable: str) -> str | None:
        """What is wrong with one: the module of its function is not there."""
        entry = self.entry_points.get(executable)
        if entry is None:
            return None
        file, place = self.file_of(entry), self.folder / "setup.py"
        if file.is_file():
            return None
        near = did_you_mean(file.stem, (), hidden=[one.stem for one in file.parent.glob("*.py")])
        next_step = near or "; write that module, or name another one there"
        return f"{place}: {executable} is {entry.module}:{entry.function}, and there is no {file}{next_step}"

    def file_of(self, entry: EntryPoint) -> Path:
        """Where the module of an executable has to be."""
        return self.python_folder.joinpath(*entry.module.split(".")).with_suffix(".py")

    def path_of(self, executable: str, root: Path) -> str:
        """The module and the function of an executable, as `src.lamp.lamp.node:main`; without one for a file."""
        entry = self.entry_points.get(executable)
        file = self.programs[executable] if entry is None else self.file_of(entry)
        inside = file.relative_to(root) if file.is_relative_to(root) else file
        module = ".".join(inside.with_suffix("").parts)
        return module if entry is None else f"{module}:{entry.function}"

    def known_as(self, executable: str) -> str | None:
        """The name of an executable that is asked for with or without `.py`; None if there is none."""
        names = (executable, f"{executable}.py", executable.removesuffix(".py"))
        return next((name for name in names if name in self.entry_points or name in self.programs), None)


@dataclass(frozen=True)
class Workspace:
    """The packages below a folder, by name."""

    root: Path
    packages: Mapping[str, Package] = field(default_factory=dict)
    doubles: tuple[Package, ...] = ()
    """Packages whose names others have that were met before them."""

    @property
    def import_roots(self) -> list[Path]:
        """The folders of packages from which Python imports."""
        return [root for package in self.packages.values() for root in package.import_roots]

    @property
    def replaced(self) -> dict[str, Path]:
        """Packages that Python would import from here, had graphflow not its own: source trees of rclpy, tf2_ros."""
        own = os.listdir(SITE)
        return {
            name: root / name for root in self.import_roots for name in own if (root / name / "__init__.py").is_file()
        }

    @property
    def interfaces(self) -> dict[str, Path]:
        """The folders of packages that define messages, services or actions."""
        return {p.name: p.folder for p in self.packages.values() if p.has_interfaces}


def find_workspace(start: Path) -> Workspace:
    """The workspace that a folder or file belongs to, or else what is below the folder.

    Returns:
        One without packages where there is none.
    """
    start = start.resolve()
    return workspace_around(start) or (read_workspace(start, start) if start.is_dir() else Workspace(start))


def workspace_around(start: Path) -> Workspace | None:
    """The workspace that a folder or file lies in: the nearest above with packages in its `src`, or beside its own."""
    start = start.resolve()
    folders = [start, *start.parents] if start.is_dir() else list(start.parents)
    for folder in folders:
        if (folder / "src").is_dir() and next(_walk(folder / "src"), None) is not None:
            return read_workspace(folder, folder / "src")
    highest = next((f for f in reversed(folders) if (f / "package.xml").is_file()), None)
    if highest is not None:  # beside it there may be others, and below the folder that one stands in
        here = Path.cwd()
        if here in highest.parent.parents and here not in (Path(here.anchor), home()):  # which hold anything
            around = read_workspace(here, here)
            if any(package.folder == highest for package in around.packages.values()):
                return around
        return read_workspace(highest.parent, highest.parent)
    return None


@cache
def bundled() -> Workspace:
    """The packages that come with graphflow."""
    return read_workspace(BUNDLED, BUNDLED)


def read_workspace(root: Path, source: Path) -> Workspace:
    """The packages below `source`; of two with the same name, the one that is met first."""
    packages: dict[str, Package] = {}
    doubles: list[Package] = []
    for package in islice(_walk(source), PACKAGES_BOUND):
        if packages.setdefault(package.name, package) is not package:
            doubles.append(package)
    return Workspace(root, packages, tuple(doubles))


class Folder(NamedTuple):
    """A folder in which packages are looked for."""

    path: Path
    files: set[str]
    """The names of its files."""
    package: str | None
    """The name in its `package.xml`; None if it is no package."""

    @property
    def mark(self) -> str | None:
        """The file that leaves it, and all below, out of the workspace."""
        return next((mark for mark in _MARKS if mark in self.files), None)


def _walk(source: Path) -> Iterator[Package]:
    return (Package(found.package, found.path) for found in folders(source) if found.package is not None)


def folders(source: Path) -> Iterator[Folder]:
    """The folders of packages and those above, the nearest first; there may be any number that are no packages."""
    waiting = deque([(source, 0)])
    for _ in range(FOLDERS_BOUND):
        if not waiting:
            return
        path, depth = waiting.popleft()
        inside, files = _listing(path)
        name = _NAME.search(_text(path / "package.xml")) if "package.xml" in files else None
        found = Folder(path, files, None if name is None else name[1])
        if found.mark is not None:
            yield found._replace(package=None)
            continue
        yield found
        if name is None and depth < DEPTH:  # packages lie side by side
            waiting.extend((path / f, depth + 1) for f in inside if not f.startswith(".") and f not in _LEFT_OUT)


def _listing(folder: Path) -> tuple[list[str], set[str]]:
    """The names of a folder's folders, sorted, and of its files."""
    try:
        _, folders, files = next(os.walk(folder), ("", [], []))
    except OSError:
        return [], set()
    return sorted(f for f in folders if not (folder / f).is_symlink()), set(files)


def _text(file: Path) -> str:
    try:
        return found_text(file, "replace")
    except OSError:
        return ""


def cmake_text(package: Package) -> str:
    """The `CMakeLists.txt` of a package without its comments, and with what its variables plainly stand for."""
    text = re.sub(r"#.*", "", _text(package.folder / "CMakeLists.txt"))
    known = {"PROJECT_NAME": package.name, "CMAKE_CURRENT_SOURCE_DIR": ".", "PROJECT_SOURCE_DIR": "."}

    def put_in(text: str) -> str:
        return _VARIABLE.sub(lambda found: known.get(found[1], found[0]), text)

    for name, value in _SET.findall(text):
        known.setdefault(name, put_in(value.replace('"', " ")).strip()[:_VALUE_BOUND])
    return put_in(text)


def _package_dir(file: Path) -> str:
    """The folder that a `setup.py` has its modules in, from its own on."""
    try:
        tree = ast.parse(_text(file))
    except (SyntaxError, ValueError):
        return ""
    for node in ast.walk(tree):
        match node:
            case ast.keyword(arg="package_dir", value=ast.Dict(keys=[ast.Constant(value="")], values=[value])):
                return constant_text(value, constants(tree)) or ""
    return ""


def _of_setup_cfg(file: Path) -> dict[str, EntryPoint]:
    parser = configparser.ConfigParser()
    try:
        parser.read_string(_text(file))
        lines = parser.get("options.entry_points", "console_scripts", fallback="").splitlines()
    except configparser.Error:
        return {}
    return dict(script for line in lines if (script := _script(line)) is not None)


def _script(text: str) -> tuple[str, EntryPoint] | None:
    found = _SCRIPT.fullmatch(text)
    return None if found is None else (found[1], EntryPoint(found[2], found[3]))


def _of_setup_py(file: Path) -> dict[str, EntryPoint]:
    """The texts of the form `name = module:function` in `entry_points`; names of the file's own are put in."""
    try:
        tree = ast.parse(_text(file))
    except (SyntaxError, ValueError):
        return {}
    known = constants(tree)
    found = {}
    for node in _of_console_scripts(tree):
        text = constant_text(node, known)
        script = None if text is None else _script(text)
        if script is not None:
            found[script[0]] = script[1]
    return found


def _computes_scripts(file: Path) -> bool:
    """Whether `console_scripts` of a `setup.py` are not all plain to see."""
    try:
        tree = ast.parse(_text(file))
    except (SyntaxError, ValueError):
        return False
    known = constants(tree)
    return any(
        not isinstance(value, (ast.List, ast.Tuple)) or any(constant_text(one, known) is None for one in value.elts)
        for value in _under_console_scripts(tree)
    )


def _under_console_scripts(tree: ast.Module) -> list[ast.expr]:
    dicts = (node for node in ast.walk(tree) if isinstance(node, ast.Dict))
    pairs = (pair for one in dicts for pair in zip(one.keys, one.values, strict=True))
    return [value for key, value in pairs if isinstance(key, ast.Constant) and key.value == "console_scripts"]


def _of_console_scripts(tree: ast.Module) -> Iterator[ast.AST]:
    """What stands under `console_scripts`: in a literal list, or else anywhere in a file that has such a group."""
    literal = [value for value in _under_console_scripts(tree) if isinstance(value, (ast.List, ast.Tuple))]
    texts = (node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str))
    tops: list[ast.AST] = [*literal] if literal else [tree] if any("console_scripts" in text for text in texts) else []
    return (node for top in tops for node in ast.walk(top))


def constants(tree: ast.Module) -> dict[str, str]:
    """The names of a module that stand for texts."""
    known: dict[str, str] = {}
    for statement in tree.body:
        match statement:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                text = constant_text(value, known)
                if text is not None:
                    known[name] = text
    return known


def constant_text(node: ast.AST, known: Mapping[str, str]) -> str | None:
    """The text that an expression is; None where that is not plain to see."""
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.Name(id=name):
            return known.get(name)
        case ast.JoinedStr(values=values):
            parts = [constant_text(value, known) for value in values]
            return None if any(part is None for part in parts) else "".join(part or "" for part in parts)
        case ast.FormattedValue(value=value):
            return constant_text(value, known)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            one, other = constant_text(left, known), constant_text(right, known)
            return None if one is None or other is None else one + other
        case ast.Call(func=ast.Attribute(attr="join"), args=[_, *_] as parts):
            texts = [constant_text(part, known) for part in parts]
            return None if None in texts else os.path.join(*map(str, texts))
    return None


def _of_cmake(package: Package) -> Iterator[tuple[str, Path]]:
    """The programs that `CMakeLists.txt` installs below `lib/`."""
    for installed in _INSTALL.findall(cmake_text(package)):
        words = installed.replace('"', " ").split()
        upper = [word.upper() for word in words]
        if "DESTINATION" not in upper:
            continue
        files = words[: upper.index("DESTINATION")]
        destination = words[upper.index("DESTINATION") + 1] if upper[-1] != "DESTINATION" else ""
        if not destination.startswith("lib"):
            continue
        renamed = words[upper.index("RENAME") + 1] if "RENAME" in upper[:-1] else ""
        for word in files:
            file = package.folder / word
            if file.is_file():
                yield renamed or file.name, file


def uses_ros(file: Path) -> bool:
    """Whether a Python file imports rclpy or launch, itself or in a function of it."""
    try:
        tree = ast.parse(_text(file))
    except (SyntaxError, ValueError):
        return False
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=names) if any(alias.name.partition(".")[0] in _ROS for alias in names):
                return True
            case ast.ImportFrom(module=str(module), level=0) if module.partition(".")[0] in _ROS:
                return True
    return False
