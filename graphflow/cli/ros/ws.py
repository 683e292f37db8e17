"""`graphflow ws`: show and check the packages of a ROS 2 workspace, which need not be built."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from graphflow.cli import exits, output
from graphflow.names import did_you_mean

if TYPE_CHECKING:
    from graphflow.workspace.packages import Package, Workspace

_HABITS = {
    "init": "A workspace needs no initialization: it is a folder that has packages in src/.",
    **dict.fromkeys(("build", "source", "clean"), "Nothing has to be built or sourced: what you edit is what runs."),
    "test": "Nothing has to be built; a package's tests are run by: python -m pytest src/PACKAGE",
}
"""Verbs of build tools, each with the reason that it is not needed."""
SHOWN = 4
"""Most names in a cell of the table."""


@click.command(context_settings={"ignore_unknown_options": True})
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.argument("habit", nargs=-1, type=click.UNPROCESSED, metavar="[init|build|test|source]...")
def ws(as_json: bool, habit: tuple[str, ...]) -> int:
    """Show the packages of a ROS 2 workspace, which need not be built.

    The workspace is the one that the current folder is in. If its packages have faults, they are reported and the exit
    code is 1.
    """
    from graphflow.errors import UsageFault
    from graphflow.msgs import registry
    from graphflow.names import did_you_mean
    from graphflow.workspace.packages import find_workspace
    from graphflow.workspace.unfound import no_packages

    if habit and habit[0] not in _HABITS:
        raise UsageFault(f"ws takes no argument {habit[0]!r}{did_you_mean(habit[0], _HABITS)}")
    if habit and not as_json:
        output.talk(_HABITS[habit[0]])
    workspace = find_workspace(Path.cwd())
    lacking = no_packages(workspace)
    if not workspace.packages:
        new = "in src/, graphflow pkg create --build-type ament_python NAME creates one"
        none = f"there is no package in {workspace.root}: go to a folder that has packages in src/; {new}"
        for fault in no_packages(workspace, setup_is_enough=True) or [none]:
            output.error(fault)
        return exits.FAILED
    for name, folder in workspace.interfaces.items():
        registry.add_package(name, folder)
    interfaces = {package.name: _interfaces_of(package) for package in workspace.packages.values()}
    faults = [*lacking, *_package_faults(workspace)]
    faults += [fault for package, names in interfaces.items() for fault in _interface_faults(package, names)]
    if as_json:
        _print_json(workspace, interfaces, faults)
    else:
        _print(workspace, interfaces, faults)
    return exits.FAILED if faults else exits.OK


def _interfaces_of(package: Package) -> list[str]:
    """Return the types of a package, as `kind/Name`."""
    from graphflow.msgs import registry
    from graphflow.workspace.packages import KINDS

    kinds = KINDS if package.has_interfaces else ()
    return [f"{kind}/{name}" for kind in kinds for name in registry.names_in(package.name, kind)]


def _package_faults(workspace: Workspace) -> Iterator[str]:
    """Report faults of packages: in their own files, invalid names, and names that hide or repeat others."""
    from graphflow.workspace.executables import of_ros
    from graphflow.workspace.manifest import fault_of, leftovers, name_fault

    packages = workspace.packages.values()
    for package in packages:
        yield from package.faults
    for package in packages:
        if (not_xml := fault_of(package.folder / "package.xml")) is not None:
            yield not_xml
    for package in packages:
        if (wrong_name := name_fault(package.folder, package.name)) is not None:
            yield wrong_name
        else:
            yield from leftovers(package.folder, package.name)
    for package in packages:
        if package.name in of_ros() and package.name not in workspace.replaced and package.import_roots:
            yield f"{package.folder} hides ROS 2's {package.name}; rename it, there and in its files"
    yield from filter(None, map(_unbuilt_interfaces, packages))
    for double in workspace.doubles:
        first = workspace.packages[double.name].folder
        if (wrong_name := name_fault(double.folder, double.name)) is not None:
            yield wrong_name
        yield f"{double.folder}: another package is called {double.name!r}, too, and takes precedence: {first}"


def _unbuilt_interfaces(package: Package) -> str:
    """Return the fault of a CMakeLists.txt that does not name all interfaces; "" if it has none."""
    from graphflow.workspace.packages import cmake_text

    cmake = cmake_text(package)
    listed = re.findall(r"(?<![\w/}.-])((?:msg|srv|action)/\w+\.(?:msg|srv|action))\b", cmake)
    elsewhere = package.misplaced_interfaces.values()  # which have been reported
    for file in listed:
        if not (package.folder / file).is_file() and package.folder / file not in elsewhere:
            there = [f"{name}.{name.partition('/')[0]}" for name in _interfaces_of(package)]
            near = did_you_mean(file, [name for name in there if name not in listed])
            return f"{package.folder / 'CMakeLists.txt'}: {file} is listed and does not exist{near}"
    files = [f"{name}.{name.partition('/')[0]}" for name in _interfaces_of(package)]
    unbuilt = [f'"{file}"' for file in files if file not in cmake]
    if not cmake or not unbuilt or "GLOB" in cmake:
        return ""
    text = f"{package.folder / 'CMakeLists.txt'}: some interfaces are missing, so that ROS 2 would not build them"
    return f"{text}; add to rosidl_generate_interfaces: {' '.join(unbuilt)}"


def _interface_faults(package: str, names: Iterable[str]) -> Iterator[str]:
    """Report types with invalid names, and types whose definition or fields are invalid."""
    from graphflow.errors import InterfaceError, UnknownInterface
    from graphflow.msgs import registry
    from graphflow.msgs.misplaced import IN_CAMEL, camel
    from graphflow.wire.idl import is_type_name

    for name in names:
        base, full = name.rpartition("/")[2], f"{package}/{name}"
        if not is_type_name(base):
            file = registry.definition_file(full)
            right = file.with_name(f"{camel(base)}{file.suffix}")
            yield f"{file} must be {right}{IN_CAMEL}"
            continue
        try:
            registry.hash_of(full)  # parses the definition and those of all nested types
        except UnknownInterface as error:
            yield f"{registry.definition_file(full)}: {error}"
        except InterfaceError as error:  # its text begins with the file
            yield str(error)


def _print_json(workspace: Workspace, interfaces: Mapping[str, list[str]], faults: list[str]) -> None:
    packages = [
        {"package": p.name, "folder": str(p.folder), "executables": p.executables, "interfaces": interfaces[p.name]}
        for p in workspace.packages.values()
    ]
    output.as_json({"root": str(workspace.root), "packages": packages, "faults": faults})


def _print(workspace: Workspace, interfaces: Mapping[str, list[str]], faults: list[str]) -> None:
    from graphflow.workspace.unfound import inner_workspaces, outer_workspace, uninstalled_files

    outer = outer_workspace(workspace)
    if outer is not None:
        output.talk(f"This workspace is within another one, whose packages are not visible from here: {outer.root}")
    for inner in inner_workspaces(workspace):
        output.talk(
            f"{inner.relative_to(workspace.root)} is a workspace of its own, whose packages are visible here, too"
        )
    packages = workspace.packages.values()
    rows = [("PACKAGE", "EXECUTABLES", "INTERFACES", "FOLDER")]
    for p in packages:
        folder = str(p.folder.relative_to(workspace.root))
        rows.append((p.name, _some(p.executables), _some(interfaces[p.name]), folder))
    output.lines(output.columns(rows))
    for fault in faults:
        output.error(fault)
    for lacks in filter(None, map(uninstalled_files, packages)):
        output.talk(f"note: {lacks}")
    for name, place in workspace.replaced.items():
        output.talk(f"{place} is not imported: graphflow has {name} itself")
    if not faults and any(p.executables for p in packages):
        output.talk("Start one with: graphflow run PACKAGE EXECUTABLE")


def _some(names: list[str]) -> str:
    """Return the first names of a list; `--json` prints all."""
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(names[:SHOWN]) + more or "-"
