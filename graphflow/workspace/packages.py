"""ROS 2 workspaces, read without building them: the packages below a folder, with their executables.

The executables of a package are read from its `setup.py`, `setup.cfg` or `CMakeLists.txt`, without running these.
"""

from __future__ import annotations

import os
import re
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from importlib.machinery import PathFinder
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from graphflow.folders import home
from graphflow.msgs.misplaced import misplaced
from graphflow.names import nearest
from graphflow.reading import lenient_text
from graphflow.system import SITE
from graphflow.workspace.setup_file import EntryPoint, SetupFile, entry_point, function_fault, starts_nodes
from graphflow.workspace.source_kinds import is_graphflows

DEPTH = 5
"""Depth in folders of the search for packages below a workspace."""
FOLDERS_BOUND = 5000
"""Number of folders that are searched: the working directory may be any folder, even `/`."""
PACKAGES_BOUND = 1000
_VALUE_BOUND = 10_000
"""Length in characters of the value of a CMake variable."""
_LEFT_OUT = {"build", "install", "log", "node_modules", "__pycache__", "venv"}
"""Folders that colcon makes, and others without packages."""
_MARKS = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
"""Files that exclude their folder and everything below it."""
_NAME = re.compile(r"<name>\s*([\w-]+)\s*</name>")
_INSTALL = re.compile(r"install\s*\(\s*(?:PROGRAMS|FILES)\s+(.*?)\)", re.DOTALL | re.IGNORECASE)
_COMPILED = re.compile(r"add_executable\s*\(\s*([\w${}-]+)", re.IGNORECASE)
_SET = re.compile(r"\bset\s*\(\s*(\w+)\s+([^()]+?)\s*\)", re.IGNORECASE)
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_MODULES = re.compile(r"ament_python_install_package\s*\(\s*([\w${}-]+)(?:\s+PACKAGE_DIR\s+([^\s)]+))?", re.IGNORECASE)
_SETUPS = ("setup.py", "CMakeLists.txt", "pyproject.toml")
"""Files of a package that may declare executables."""
KINDS = ("msg", "srv", "action")
_NEAR_KINDS = {*KINDS, "msgs", "message", "messages", "srvs", "service", "services", "actions"}
"""Names of folders, in lower case, that are probably meant for interface definitions."""
BUNDLED = Path(__file__).parents[1] / "rclpy" / "packages"
"""The bundled packages with programs of ROS 2, in the layout of a workspace."""


@dataclass(frozen=True)
class Package:
    """A package of a workspace."""

    name: str
    folder: Path

    @property
    def import_roots(self) -> list[Path]:
        """The folders to import from: those of its Python packages, of CMake's, and of its executables."""
        folders = {self.folder / self.name, self.python_folder / self.name}
        for name, folder in _MODULES.findall(cmake_text(self)):
            folders.add(self.folder / (folder or name).strip('"'))
        roots = {folder.parent for folder in folders if next(folder.glob("*.py"), None) is not None}
        if any(self.file_of(entry).is_file() for entry in self.entry_points.values()):
            roots.add(self.python_folder)
        return sorted(roots)

    @cached_property
    def setup(self) -> SetupFile:
        """Its `setup.py`, which need not exist."""
        return SetupFile(self.folder / "setup.py", lenient_text(self.folder / "setup.py"))

    @cached_property
    def python_folder(self) -> Path:
        """The root folder of its modules: its own, unless `setup.py` has `package_dir={"": "src"}`."""
        return self.folder / self.setup.package_dir

    @property
    def has_interfaces(self) -> bool:
        """Whether it defines messages, services or actions."""
        return any(self.has_kind(kind) for kind in KINDS)

    def has_kind(self, kind: str) -> bool:
        """Return whether it defines interfaces of a kind: `msg`, `srv` or `action`."""
        return next((self.folder / kind).rglob(f"*.{kind}"), None) is not None

    @property
    def misplaced_interfaces(self) -> dict[Path, Path]:
        """Interface definitions that are not read, as those in `msgs/` or in no folder, with their right paths."""
        found = misplaced(self.folder, self.name)
        return {f: to for f, to in found.items() if f.parent == self.folder or f.parent.name.lower() in _NEAR_KINDS}

    @cached_property
    def entry_points(self) -> Mapping[str, EntryPoint]:
        """Executables that are functions, by name."""
        return {**self.setup.entry_points, **self._setup_cfg[0]}

    @cached_property
    def _setup_cfg(self) -> tuple[dict[str, EntryPoint], list[str]]:
        return _of_setup_cfg(self.folder / "setup.cfg")

    @cached_property
    def programs(self) -> Mapping[str, Path]:
        """Executables that are files, by name: installed by CMake, or in `scripts/`."""
        files = (file for file in sorted((self.folder / "scripts").glob("*")) if file.is_file())
        known = {file.name: file for file in files if file.name != "__init__.py" and not file.name.startswith(".")}
        return known | dict(_of_cmake(self))

    @property
    def executables(self) -> list[str]:
        """The names of all executables."""
        return sorted({*self.entry_points, *self.programs})

    @property
    def compiled(self) -> set[str]:
        """The executables that need a compiler."""
        return {*_COMPILED.findall(cmake_text(self))}

    @property
    def faults(self) -> list[str]:
        """Faults of its executables and interface definitions."""
        found = self._no_setup + self.build_faults
        found += [fault for name in self.entry_points if (fault := self.fault_of(name)) is not None]
        found += [fault for name in self.entry_points if (fault := self.copy_fault(name)) is not None]
        found += [f"{file} must be {right}" for file, right in self.misplaced_interfaces.items()]
        if self.setup.computes_scripts:
            file = self.setup.file
            found.append(f"{file}: it computes some executables, and is only read; run their files: graphflow run FILE")
        return found

    @property
    def build_faults(self) -> list[str]:
        """Faults of its `setup.py`, and folders that run from source but that a build would leave out."""
        line = self.setup.finds_packages
        lacking = [f for f in self._module_folders if not (f / "__init__.py").is_file()] if line is not None else []
        where = f"find_packages() in {self.setup.file}:{line}"
        return [*self.setup.faults, *self._setup_cfg[1]] + [
            f"{folder} has no __init__.py: {where} leaves such folders out of what ROS 2 builds; make an empty one: "
            f"touch {folder / '__init__.py'}"
            for folder in lacking
        ]

    @property
    def _module_folders(self) -> list[Path]:
        """The folders that a build must find as Python packages: that of its name, and those of its executables."""
        own = self.python_folder / self.name
        folders = {own} if next(own.glob("*.py"), None) is not None else set()
        for entry in self.entry_points.values():
            file = self.file_of(entry)
            if file.is_file():
                folders |= {parent for parent in file.parents if parent.is_relative_to(self.python_folder)}
        return sorted(folders - {self.python_folder})

    @property
    def why_no_executable(self) -> str:
        """The faults of `setup.py` as the end of a message, which may explain a missing executable; or empty."""
        unnamed = [] if self.entry_points else self.setup.without_executables(self.name)
        return "".join(f"; {fault}" for fault in [*self._no_setup, *self.setup.faults, *self._setup_cfg[1]] or unnamed)

    @property
    def _no_setup(self) -> list[str]:
        """The fault of a package with modules but no file that declares executables; or empty."""
        has_modules = any(file.name != "__init__.py" for file in (self.folder / self.name).glob("*.py"))
        if not has_modules or self.entry_points or any((self.folder / name).is_file() for name in _SETUPS):
            return []
        return [f"{self.folder} has no setup.py, whose console_scripts name the executables"]

    def fault_of(self, executable: str) -> str | None:
        """Return the fault of an executable: its module or function does not exist; None for none."""
        entry = self.entry_points.get(executable)
        if entry is None:
            return None
        file, line = self.file_of(entry), self.setup.lines.get(executable)
        place = f"{self.setup.file}:{line}" if line is not None else f"{self.folder / 'setup.cfg'}"
        head = f"{place}: {executable} is {entry.module}:{entry.function}, and"
        if file.is_file():
            fault = None if is_graphflows(file) else function_fault(entry, file, lenient_text(file))
            return None if fault is None else f"{head} {fault}"
        top = entry.module.partition(".")[0]
        if (folder := self.setup.renamed.get(top)) is not None:
            return f"{head} package_dir has {top} in {folder}, which cannot be run from source; call it {top}"
        if not (self.python_folder / top).exists() and _is_elsewhere(top, self.folder):
            return None
        if entry.module.endswith(".py"):
            return f"{head} modules are named without .py; write {entry.module.removesuffix('.py')}:{entry.function}"
        if (
            top == self.name
            and not file.parent.exists()
            and (other := next(iter(self.python_folder.glob(f"*/{file.name}")), None))
        ):
            return f"{head} there is no folder {file.parent}; {other} is there: rename its folder to {file.parent.name}"
        near, above = self._nearest_module(entry.module), file.parent.parent / file.name
        meant = f"did you mean {near}:{entry.function}?" if near else "write that module, or name another one there"
        too_high = f"{above} is one folder too high: move it into {file.parent}" if above.is_file() else ""
        return f"{head} there is no {file}; {too_high or meant}"

    def missing_entry(self, executable: str) -> str:
        """Return the entry that `setup.py` lacks for a module of that name, to append; empty if there is none."""
        module = self.folder / self.name / f"{executable.removesuffix('.py')}.py"
        if not module.is_file() or not (self.folder / "setup.py").is_file():
            return ""
        line = f"{module.stem} = {self.name}.{module.stem}:main"
        return f"; {module.name} is there: add '{line}', to the console_scripts of {self.folder / 'setup.py'}"

    def copy_fault(self, executable: str) -> str | None:
        """Return the fault of an entry that is a copy of another but for its name, which is that of another module."""
        entry, line = self.setup.entry_points.get(executable), self.setup.lines.get(executable)
        first = next((name for name, other in self.entry_points.items() if other == entry), executable)
        if entry is None or first == executable:
            return None
        meant = EntryPoint(f"{entry.module.rpartition('.')[0]}.{executable}".lstrip("."), entry.function)
        file = self.file_of(meant)
        is_started = any(other.module == meant.module for other in self.entry_points.values())
        if (
            is_started
            or not file.is_file()
            or not starts_nodes(lenient_text(file), entry.function)
            or self._imports(file)
        ):
            return None
        return (
            f"{self.setup.file}:{line}: {executable} starts {entry.module}:{entry.function}, as {first} does, and "
            f"{file.relative_to(self.folder)} has a {entry.function}() that nothing starts; "
            f"write {executable} = {meant.module}:{meant.function}"
        )

    def _imports(self, module: Path) -> bool:
        """Return whether another file of the package refers to a module: to import it, or to run its file."""
        word = re.compile(
            rf"\b{re.escape(module.stem)}(\.py\b|\b.*\bimport\b)|\bimport\b.*\b{re.escape(module.stem)}\b"
        )
        files = (file for file in self.folder.rglob("*.py") if file not in (module, self.setup.file))
        return any(word.search(lenient_text(file)) for file in files)

    def _nearest_module(self, name: str) -> str | None:
        """Return the module whose last part is that of a name, or else the most similar one that no entry names."""
        files = (self.python_folder / self.name).rglob("*.py")
        known = [".".join(file.relative_to(self.python_folder).with_suffix("").parts) for file in sorted(files)]
        known = [module for module in known if not module.endswith("__init__")]
        last, named = name.rpartition(".")[2], {entry.module for entry in self.entry_points.values()}
        same = next((module for module in known if module.endswith(f".{last}")), None)
        return same or nearest(name, [module for module in known if module not in named])

    def file_of(self, entry: EntryPoint) -> Path:
        """Return the file of an executable's module, which need not exist."""
        path = self.python_folder.joinpath(*entry.module.split("."))
        return path / "__init__.py" if (path / "__init__.py").is_file() else path.with_suffix(".py")

    def path_of(self, executable: str, root: Path) -> str:
        """Return the module and function of an executable, as `src.lamp.lamp.node:main`; only the module for a file."""
        entry = self.entry_points.get(executable)
        file = self.programs[executable] if entry is None else self.file_of(entry)
        inside = file.relative_to(root) if file.is_relative_to(root) else file
        module = ".".join(inside.with_suffix("").parts)
        return module if entry is None else f"{module}:{entry.function}"

    def known_as(self, executable: str) -> str | None:
        """Return the name of an executable that is given with or without `.py`; None if there is none."""
        names = (executable, f"{executable}.py", executable.removesuffix(".py"))
        return next((name for name in names if name in self.entry_points or name in self.programs), None)


@dataclass(frozen=True)
class Workspace:
    """The packages below a folder, by name."""

    root: Path
    packages: Mapping[str, Package] = field(default_factory=dict)
    doubles: tuple[Package, ...] = ()
    """Packages with the name of another that was found before."""

    def way_to_double(self, name: str) -> str:
        """Return how to use another package of that name, for an error of the first; empty if there is none."""
        other = next((double.folder for double in self.doubles if double.name == name), None)
        return f"; to use {other} instead: cd {other}" if other is not None else ""

    @property
    def import_roots(self) -> list[Path]:
        """The import roots of all packages."""
        return [root for package in self.packages.values() for root in package.import_roots]

    @property
    def replaced(self) -> dict[str, Path]:
        """Source trees in the workspace, such as rclpy and tf2_ros, that graphflow's own packages replace."""
        own = os.listdir(SITE)
        sources = [folder for p in self.packages.values() for folder in (p.folder, p.folder / "src")]
        roots = [*self.import_roots, *sources]  # the names of package and module differ, as those of tf2_ros_py
        return {name: root / name for root in roots for name in own if (root / name / "__init__.py").is_file()}

    @property
    def interfaces(self) -> dict[str, Path]:
        """The folders of packages with interface definitions, even in folders of wrong names, by package."""
        return {p.name: p.folder for p in self.packages.values() if p.has_interfaces or p.misplaced_interfaces}


def find_workspace(start: Path) -> Workspace:
    """Return the workspace around a folder or file, or else the packages below the folder.

    Returns:
        A workspace without packages if there is none.
    """
    start = start.resolve()
    return workspace_around(start) or (read_workspace(start, start) if start.is_dir() else Workspace(start))


def workspace_around(start: Path) -> Workspace | None:
    """Find the workspace around a folder or file: the nearest with packages in `src`, or around the own package."""
    start = start.resolve()
    folders = [start, *start.parents] if start.is_dir() else list(start.parents)
    for folder in folders:
        if (folder / "src").is_dir() and next(_walk(folder / "src"), None) is not None:
            return read_workspace(folder, folder / "src")
    highest = next((f for f in reversed(folders) if (f / "package.xml").is_file()), None)
    if highest is not None:  # other packages may be beside it, or below the working directory
        here = Path.cwd()
        # The root and the home folder may contain anything, and are no workspaces.
        if here in highest.parent.parents and here not in (Path(here.anchor), home()):
            around = read_workspace(here, here)
            if any(package.folder == highest for package in around.packages.values()):
                return around
        return read_workspace(highest.parent, highest.parent)
    return None


@cache
def bundled() -> Workspace:
    """Return the bundled packages."""
    return read_workspace(BUNDLED, BUNDLED)


def read_workspace(root: Path, source: Path) -> Workspace:
    """Read the packages below `source`; of several with one name, the first is kept."""
    packages: dict[str, Package] = {}
    doubles: list[Package] = []
    for package in islice(_walk(source), PACKAGES_BOUND):
        if packages.setdefault(package.name, package) is not package:
            doubles.append(package)
    return Workspace(root, packages, tuple(doubles))


class Folder(NamedTuple):
    """A folder in the search for packages."""

    path: Path
    files: set[str]
    """The names of its files."""
    package: str | None
    """The name in its `package.xml`; None if it is no package."""

    @property
    def mark(self) -> str | None:
        """The file that excludes it, and everything below it, from the workspace."""
        return next((mark for mark in _MARKS if mark in self.files), None)


def _walk(source: Path) -> Iterator[Package]:
    return (Package(found.package, found.path) for found in folders(source) if found.package is not None)


def folders(source: Path) -> Iterator[Folder]:
    """Yield the folders of packages and those above them, breadth first."""
    waiting = deque([(source, 0)])
    for _ in range(FOLDERS_BOUND):
        if not waiting:
            return
        path, depth = waiting.popleft()
        inside, files = _listing(path)
        name = _NAME.search(lenient_text(path / "package.xml")) if "package.xml" in files else None
        found = Folder(path, files, None if name is None else name[1])
        if found.mark is not None:
            yield Folder(path, files, None)
            continue
        yield found
        if name is None and depth < DEPTH:  # packages are not nested
            waiting.extend((path / f, depth + 1) for f in inside if not f.startswith(".") and f not in _LEFT_OUT)


def _listing(folder: Path) -> tuple[list[str], set[str]]:
    """Return the names of the folders in a folder, sorted, and those of its files."""
    try:
        _, folders, files = next(os.walk(folder), ("", [], []))
    except OSError:
        return [], set()
    # Links may lead in a circle.
    return sorted(f for f in folders if not (folder / f).is_symlink()), set(files)


def cmake_text(package: Package) -> str:
    """Read the `CMakeLists.txt` of a package, without comments and with literal variables substituted."""
    text = re.sub(r"#.*", "", lenient_text(package.folder / "CMakeLists.txt"))
    known = {"PROJECT_NAME": package.name, "CMAKE_CURRENT_SOURCE_DIR": ".", "PROJECT_SOURCE_DIR": "."}

    def expanded(text: str) -> str:
        return _VARIABLE.sub(lambda found: known.get(found[1], found[0]), text)

    for name, value in _SET.findall(text):
        known.setdefault(name, expanded(value.replace('"', " ")).strip()[:_VALUE_BOUND])
    return expanded(text)


def _is_elsewhere(module: str, folder: Path) -> bool:
    """Return whether a module belongs to a package beside a folder, or is installed."""
    beside = folder.parent / module
    return (beside != folder and (beside / "package.xml").is_file()) or PathFinder.find_spec(module) is not None


def _of_setup_cfg(file: Path) -> tuple[dict[str, EntryPoint], list[str]]:
    """Return the executables of a `setup.cfg`, and the faults of its lines."""
    import configparser

    parser, text = configparser.ConfigParser(), lenient_text(file)
    try:
        parser.read_string(text)
        lines = parser.get("options.entry_points", "console_scripts", fallback="").splitlines()
    except configparser.ParsingError as error:
        line = getattr(error, "lineno", 0) or error.errors[0][0]
        return {}, [f"{file}:{line}: it is neither [section] nor KEY = VALUE, so the file has no executables"]
    except configparser.Error as error:
        return {}, [f"{file}: {error}"]
    written = [line.strip() for line in text.splitlines()]
    faults = [
        f"{file}:{written.index(line.strip()) + 1}: {line.strip()!r} names no function; write "
        "'NAME = PACKAGE.MODULE:FUNCTION'"
        for line in lines
        if line.strip() and entry_point(line) is None and line.strip() in written
    ]
    return dict(script for line in lines if (script := entry_point(line)) is not None), faults


def _of_cmake(package: Package) -> Iterator[tuple[str, Path]]:
    """Yield the programs that `CMakeLists.txt` installs below `lib/`."""
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
