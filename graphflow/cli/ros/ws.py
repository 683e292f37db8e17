"""`graphflow ws`: show and check the packages of a ROS 2 workspace, which need not be built."""

from __future__ import annotations

from pathlib import Path

import click

from graphflow.cli import exits, output

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
    from graphflow.errors import InterfaceError, UnknownInterface, UsageFault
    from graphflow.msgs import registry
    from graphflow.names import did_you_mean
    from graphflow.wire.idl import is_type_name
    from graphflow.workspace.executables import of_ros
    from graphflow.workspace.manifest import fault_of, name_fault
    from graphflow.workspace.packages import KINDS, find_workspace
    from graphflow.workspace.unfound import no_packages, outer_workspace

    if habit and habit[0] not in _HABITS:
        raise UsageFault(f"ws takes no argument {habit[0]!r}{did_you_mean(habit[0], _HABITS)}")
    if habit and not as_json:
        output.talk(_HABITS[habit[0]])
    found = find_workspace(Path.cwd())
    lacking = no_packages(found)
    if not found.packages:
        for fault in lacking:
            output.error(fault)
        if not lacking:
            new = "in src/, graphflow pkg create --build-type ament_python NAME creates one"
            output.error(f"there is no package in {found.root}: go to a folder that has packages in src/; {new}")
        return exits.FAILED
    for name, folder in found.interfaces.items():
        registry.add_package(name, folder)
    faults = lacking + [fault for package in found.packages.values() for fault in package.faults]
    not_xml = [fault_of(package.folder / "package.xml") for package in found.packages.values()]
    other_names = [name_fault(package.folder, package.name) for package in found.packages.values()]
    faults += [fault for fault in [*not_xml, *other_names] if fault is not None]
    faults += [
        f"{package.folder} hides ROS 2's {package.name}; rename it, there and in its files"
        for package in found.packages.values()
        if package.name in of_ros() and package.name not in found.replaced and package.import_roots
    ]
    faults += [
        f"{double.folder}: another package is called {double.name!r}, too, and takes precedence: "
        f"{found.packages[double.name].folder}"
        for double in found.doubles
    ]
    rows = []
    for package in found.packages.values():
        kinds = KINDS if package.has_interfaces else ()
        shown = [f"{kind}/{name}" for kind in kinds for name in registry.names_in(package.name, kind)]
        for name in shown:
            base = name.rpartition("/")[2]
            if not is_type_name(base):
                file = registry.definition_file(f"{package.name}/{name}")
                right = file.with_name(f"{registry.camel(base)}{file.suffix}")
                faults.append(f"{file} must be {right}{registry.IN_CAMEL}")
                continue
            try:
                registry.hash_of(f"{package.name}/{name}")  # which reads the types of its fields, too
            except UnknownInterface as error:
                faults.append(f"{registry.definition_file(f'{package.name}/{name}')}: {error}")
            except InterfaceError as error:
                faults.append(str(error))
        rows.append((package, shown))
    if as_json:
        known = [
            {"package": p.name, "folder": str(p.folder), "executables": p.executables, "interfaces": shown}
            for p, shown in rows
        ]
        output.as_json({"root": str(found.root), "packages": known, "faults": faults})
    else:
        around = outer_workspace(found)
        if around is not None:
            output.talk(
                f"This workspace is within another one, whose packages are not visible from here: {around.root}"
            )
        heads = [("PACKAGE", "EXECUTABLES", "INTERFACES", "FOLDER")]
        body = [
            (p.name, _some(p.executables), _some(shown), str(p.folder.relative_to(found.root))) for p, shown in rows
        ]
        output.lines(output.columns([*heads, *body]))
        for fault in faults:
            output.error(fault)
        for name, folder in found.replaced.items():
            output.talk(f"{folder} is not imported: graphflow has {name} itself")
        if not faults and any(p.executables for p, _ in rows):
            output.talk("Start one with: graphflow run PACKAGE EXECUTABLE")
    return exits.FAILED if faults else exits.OK


def _some(names: list[str]) -> str:
    """Return the first names of a list; `--json` prints all."""
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(names[:SHOWN]) + more or "-"
