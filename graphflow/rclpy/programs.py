"""Programs written for rclpy, found and run from source: nothing is built or installed first."""

from __future__ import annotations

import os
import runpy
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from inspect import isclass, isfunction
from pathlib import Path
from types import TracebackType
from typing import NamedTuple

from graphflow.analysis import hiding
from graphflow.errors import UsageFault
from graphflow.msgs import registry
from graphflow.names import did_you_mean
from graphflow.rclpy import enabling
from graphflow.rclpy.hints import tracebacks
from graphflow.rclpy.messages import finder
from graphflow.runtime.mistakes import unrun
from graphflow.system import offer_ros2
from graphflow.wire.profile import wire_profile
from graphflow.workspace.executables import EXECUTABLES, spelling_fault
from graphflow.workspace.installed import package_of
from graphflow.workspace.manifest import fault_of
from graphflow.workspace.packages import (
    BUNDLED,
    Package,
    Workspace,
    bundled,
    find_workspace,
)
from graphflow.workspace.setup_file import EntryPoint
from graphflow.workspace.source_kinds import is_graphflows, uses_ros
from graphflow.workspace.unfound import launching


class Program(NamedTuple):
    """A program to run."""

    file: Path
    """The file, or the file of the entry point's module."""
    entry: EntryPoint | None
    """The function to call; None for a file that is run as a script."""
    workspace: Workspace
    words: list[str]
    """The program's arguments."""


def find_program(what: str, words: Sequence[str], here: Path) -> Program | None:
    """Find the program that a file, or a package (name or folder) and an executable, specify.

    Args:
        here: The folder whose workspace is searched.

    Returns:
        None if there is no such rclpy program.

    Raises:
        UsageFault: The package has no such executable, or none is named; the text lists those it has.
    """
    file = here / what
    if what.endswith(".py") and file.is_file():
        return Program(file, None, find_workspace(file), list(words)) if uses_ros(file) else None
    is_folder = (file / "package.xml").is_file()
    workspace = find_workspace(file if is_folder else here)
    packages = workspace.packages
    named = next((p for p in packages.values() if p.folder == file.resolve()), None) if is_folder else None
    package = named or packages.get(what)
    if package is None and what in bundled().packages and enabling.elsewhere() is None:
        package, workspace = bundled().packages[what], bundled()
    if package is not None and package.folder.parent == BUNDLED and (what, *words[:1]) in EXECUTABLES:
        return None  # a native node, beside the package's rclpy programs
    if package is None:
        outside = package_of(what)
        if outside is None or not words or words[0] not in outside.programs:
            return None
        return Program(*outside.programs[words[0]], find_workspace(here), list(words[1:]))
    if not words:
        if not package.executables or (workspace.root / "nodes" / f"{what}.py").is_file():  # a node of that name
            return None
        raise UsageFault(f"name an executable of the package {what!r}: {', '.join(package.executables)}")
    found = _executable(package, words[0])
    if found is None:
        has_node = workspace is bundled() or (workspace.root / "nodes" / f"{what}.py").is_file()
        if not package.executables or (words[0].startswith("-") and has_node):  # options of a node of that name
            return None
        raise _without(package, words, workspace)
    file, entry = found
    is_ours = entry is not None and is_graphflows(file)
    return None if is_ours and not is_folder else Program(file, entry, workspace, list(words[1:]))


def _without(package: Package, words: Sequence[str], workspace: Workspace) -> UsageFault:
    """Return the error for a word that is no executable of a package: an option, or an unknown name."""
    name = words[0]
    if name.startswith("-"):
        slip = ", and write --ros-args" if "-ros-args" in words else ""
        listed = ", ".join(package.executables)
        return UsageFault(f"name an executable of the package {package.name!r} before {name!r}{slip}: {listed}")
    is_explained = name.removesuffix(".py") in package.why_no_executable
    near = "" if is_explained else launching(name, [package]) or package.missing_entry(name)
    near = near or ("" if is_explained else did_you_mean(name, package.executables))
    way = f"{package.why_no_executable}{workspace.way_to_double(package.name)}"
    return UsageFault(f"package {package.name!r} has no executable {name!r}{near}{way}")


def _executable(package: Package, name: str) -> tuple[Path, EntryPoint | None] | None:
    """Return the file and entry point of an executable, given with or without `.py`."""
    known = package.known_as(name)
    if known is None:
        return None
    fault = package.fault_of(known)
    if fault is not None:
        raise UsageFault(fault)
    entry = package.entry_points.get(known)
    return (package.programs[known], None) if entry is None else (package.file_of(entry), entry)


def make_importable(workspace: Workspace) -> bool:
    """Make rclpy and the packages of a workspace importable in this process; return whether rclpy is graphflow's."""
    is_ours = enabling.here()
    if is_ours:
        for name, folder in workspace.interfaces.items():
            finder.KNOWN[name] = str(folder)
            registry.add_package(name, folder)
        for name, folder in workspace.replaced.items():
            finder.prefer_own()
            sys.stderr.write(f"note: {folder} is not imported: graphflow has {name} itself\n")
    offer_ros2()
    sys.path[:0] = [str(folder) for folder in workspace.import_roots if str(folder) not in sys.path]
    return is_ours


def run(program: Program) -> None:
    """Run a program in this process, as its main module.

    Raises:
        SystemExit: As the program raises it.
        UsageFault: Its module lacks the entry point's function.
    """
    if make_importable(program.workspace):
        import_module("rclpy")  # slow, and Ctrl-C would otherwise interrupt it in graphflow's code
    # A shell starts jobs with SIGINT ignored; rclpy ends all the same.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.environ.setdefault("ROS_DISTRO", wire_profile())  # as in any shell of ROS's
    sys.argv = [str(program.file), *program.words]
    hook = sys.excepthook
    try:
        _begin(program)
    except BaseException:  # a hook may show SystemExit and KeyboardInterrupt, too
        if sys.excepthook is hook:  # not before: some libraries check for Python's own hook
            sys.excepthook = _print_error
        raise


def _begin(program: Program) -> None:
    if program.entry is None:
        if program.file.suffix != ".py" and not _is_python(program.file):
            if not os.access(program.file, os.X_OK):
                raise UsageFault(f"{program.file} is not executable; to fix that: chmod +x {program.file}")
            os.execv(program.file, sys.argv)
        sys.path.insert(0, str(program.file.parent))
        if hiding.hides_what_it_imports(program.file):
            hiding.warn(program.file)
        runpy.run_path(str(program.file), run_name="__main__")
        unrun.report(program.file)
        return
    spec = find_spec(program.entry.module)
    _note_other(program, None if spec is None else spec.origin)
    called: object = import_module(program.entry.module)
    owner = called
    for part in program.entry.function.split("."):
        called, owner = getattr(called, part, None), called
    if not callable(called):
        known = [name for name, value in vars(owner).items() if isfunction(value)]
        near = did_you_mean(program.entry.function.rpartition(".")[2], known)
        raise UsageFault(f"{program.file} has no function {program.entry.function!r}, which its setup.py names{near}")
    if isclass(called):
        name = f"{program.entry.module}:{program.entry.function}"
        raise UsageFault(f"{name} is a class: name a function in setup.py that makes one and spins it, such as main")
    sys.exit(called())


def _note_other(program: Program, file: str | None) -> None:
    """Note that what runs is another package's, whose module has the same name, or another package of that name.

    Args:
        file: The file that will be imported for the program.
    """
    if program.entry is not None and file is not None and Path(file).is_file() and not program.file.samefile(file):
        top = program.entry.module.partition(".")[0]
        text = f"this runs {file}, and not {program.file}: two packages have a folder {top} for their modules"
        sys.stderr.write(f"note: {text}; rename one, in its setup.py as well\n")
    for double in program.workspace.doubles:
        first = program.workspace.packages[double.name].folder
        if program.file.is_relative_to(first) or program.file.is_relative_to(double.folder):
            text = f"{double.folder} is not used, since {first} is called {double.name!r}, too"
            way = "rename one, in package.xml and setup.py, or put an empty file COLCON_IGNORE into it"
            sys.stderr.write(f"note: {text}; {way}\n")


def _print_error(kind: type[BaseException], error: BaseException, _: TracebackType | None) -> None:
    """Print an error that ends a program, limited to the program's own code, with a next step."""
    tracebacks.show(kind, error)
    with suppress(KeyboardInterrupt):  # which leaves out the note
        if isinstance(error, AssertionError) and " field must be " in str(error):
            later = "ROS 2 Jazzy checks this only when the message is sent, and then aborts the process"
            sys.stderr.write(f"note: {later}; to check it only then here, too: ROS_PYTHON_CHECK_FIELDS=0\n")


def _warn_of_build_faults(program: Program, name: str) -> None:
    """Warn about what keeps ROS 2 from running the program, and about a copied line of setup.py."""
    if program.entry is not None:
        for package in program.workspace.packages.values():
            if program.file.is_relative_to(package.folder):
                known = package.known_as(name) or ""
                manifest = fault_of(package.folder / "package.xml")
                faults = [spelling_fault(package, name), manifest, *package.build_faults, package.copy_fault(known)]
                for fault in filter(None, faults):
                    sys.stderr.write(f"note: {fault}\n")


def _is_python(file: Path) -> bool:
    """Whether a file without a suffix is a Python script."""
    with file.open("rb") as opened:
        return b"python" in opened.readline(100)


def main(words: Sequence[str]) -> None:
    """Run a file, a package's executable, or `-m MODULE FILE`, with its arguments."""
    if words[0] == "-m":  # a module of graphflow's that is to read a file of a workspace
        signal.signal(signal.SIGINT, signal.default_int_handler)
        make_importable(find_workspace(Path(words[2])))
        sys.argv = list(words[1:])
        runpy.run_module(words[1], run_name="__main__", alter_sys=True)
        return
    try:
        program = find_program(words[0], words[1:], Path.cwd())
        if program is None:
            raise UsageFault(f"{' '.join(words[:2])} is not a program that uses rclpy")
        _warn_of_build_faults(program, words[1] if words[1:] else "")
        run(program)
    except UsageFault as error:
        sys.stderr.write(f"error: {error}\n")
        sys.exit(2)
