"""`graphflow ws`: the packages of a ROS 2 workspace, which nobody has to build."""

from __future__ import annotations

from pathlib import Path

import click

from graphflow.cli import exits, output

SHOWN = 4
"""Names that a cell of the table holds."""


@click.command(context_settings={"ignore_unknown_options": True})
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.argument("habit", nargs=-1, type=click.UNPROCESSED, metavar="[build|test|source]...")
def ws(as_json: bool, habit: tuple[str, ...]) -> int:
    """Show the packages of a ROS 2 workspace; nothing has to be built.

    The workspace is the one that the current folder is in. What is wrong in its packages is told, and the exit code is
    then 1.
    """
    from graphflow.errors import InterfaceError, UnknownInterface
    from graphflow.graph.workspace import KINDS, find_workspace
    from graphflow.msgs import registry

    found = find_workspace(Path.cwd())
    if not found.packages:
        output.error(
            "there is no package here: go to a folder that has packages in src/; graphflow pkg create NAME makes one"
        )
        return exits.FAILED
    for name, folder in found.interfaces.items():
        registry.add_package(name, folder)
    faults = [fault for package in found.packages.values() for fault in package.faults]
    faults += [
        f"{double.folder}: another package is called {double.name!r}, too, and is the one that counts: "
        f"{found.packages[double.name].folder}"
        for double in found.doubles
    ]
    rows = []
    for package in found.packages.values():
        kinds = KINDS if package.has_interfaces else ()
        shown = [f"{kind}/{name}" for kind in kinds for name in registry.names_in(package.name, kind)]
        for name in shown:
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
        if habit:
            output.talk("Nothing has to be built or sourced: what you edit is what runs.")
        heads = [("PACKAGE", "EXECUTABLES", "INTERFACES", "FOLDER")]
        body = [
            (p.name, _some(p.executables), _some(shown), str(p.folder.relative_to(found.root))) for p, shown in rows
        ]
        output.lines(output.columns([*heads, *body]))
        for fault in faults:
            output.error(fault)
        if not faults and any(p.executables for p, _ in rows):
            output.talk("Start one with: graphflow run PACKAGE EXECUTABLE")
    return exits.FAILED if faults else exits.OK


def _some(names: list[str]) -> str:
    """The first names of a list; `--json` has all."""
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(names[:SHOWN]) + more or "-"
