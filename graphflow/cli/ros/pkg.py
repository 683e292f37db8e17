"""`graphflow pkg list`, `executables`, `prefix`, `xml` and `create`."""

from __future__ import annotations

import os
import re
from pathlib import Path

import click

from graphflow.cli import exits, output
from graphflow.cli.messages.types import use_project
from graphflow.cli.projects.creating import create
from graphflow.cli.verbs import Verbs
from graphflow.errors import UsageFault
from graphflow.names import did_you_mean
from graphflow.reading import found_text


@click.group(cls=Verbs)
def pkg() -> None:
    """List packages and their contents, or create one."""


def _root() -> Path:
    from graphflow.workspace.project import project_root

    return project_root(Path.cwd())


def _known() -> list[str]:
    """Return the packages of graphflow, of the project and of installed distributions, and those that have types."""
    from graphflow.msgs import registry
    from graphflow.workspace.executables import project_packages, with_graphflow
    from graphflow.workspace.installed import installed

    use_project()
    return sorted(
        {package for package, _ in with_graphflow()} | {*project_packages(_root()), *installed(), *registry.packages()}
    )


def _hint(package: str) -> str:
    """Explain why a package does not exist, by its folder's state, or else suggest a similar name."""
    from graphflow.workspace.packages import find_workspace
    from graphflow.workspace.unfound import why_no_package

    known = _known()
    why = None if package in known else why_no_package(package, find_workspace(Path.cwd()))
    return did_you_mean(package, known) if why is None else f": {why}"


@pkg.command("list")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def list_(as_json: bool) -> None:
    """List the known packages."""
    output.listing(_known(), json=as_json)


@pkg.command()
@click.argument("package", default="")
@click.option("--full-path", is_flag=True, help="Print the path of each.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def executables(package: str, full_path: bool, as_json: bool) -> int:
    """List the executables of packages. `graphflow run PACKAGE EXECUTABLE` starts one."""
    from graphflow.workspace.executables import all_executables
    from graphflow.workspace.packages import find_workspace

    rows = [row for row in all_executables(_root()) if package in ("", row.package)]
    own = find_workspace(Path.cwd()).packages.get(package)
    faults = own.faults if own is not None else []
    for fault in faults:
        output.error(fault)
    code = exits.FAILED if faults else exits.OK
    if not rows and package in _known():
        output.talk(f"the package {package!r} has no executable that graphflow can run")
        return code
    if not rows:
        output.error(f"Package '{package}' not found{_hint(package)}")
        return exits.FAILED
    if as_json:
        output.as_json([{"package": r.package, "name": r.name, "class": r.class_path} for r in rows])
        return code
    for row in rows:
        where = row.class_path.partition(":")[0].replace(".", "/")
        output.data(f"{where}.py" if full_path else f"{row.package} {row.name}")
    return code


@pkg.command()
@click.argument("package")
@click.option("--share", is_flag=True, help="Print its share folder instead.")
def prefix(package: str, share: bool) -> int:
    """Print the install prefix of a package."""
    from graphflow.workspace.executables import EXECUTABLES, package_prefix, package_share
    from graphflow.workspace.project import demos_root

    found = (package_share if share else package_prefix)(package, _root(), os.environ)
    if found is None and any(package == known for known, _ in EXECUTABLES):
        found = demos_root()
    if found is None:
        output.error(f"Package not found{_hint(package)}")
        return exits.FAILED
    output.data(str(found))
    return exits.OK


@pkg.command()
@click.argument("package")
@click.option("-t", "--tag", help="Print only the contents of this tag.")
def xml(package: str, tag: str | None) -> int:
    """Print a package's package.xml."""
    from graphflow.workspace.executables import package_share

    folder = package_share(package, _root(), os.environ)
    file = folder / "package.xml" if folder is not None else None
    if file is None or not file.is_file():
        output.error(f"{package}: no package.xml was found{_hint(package)}")
        return exits.FAILED
    text = found_text(file, "replace")
    if tag is None:
        output.data(text.rstrip("\n"))
        return exits.OK
    found = re.findall(rf"<{re.escape(tag)}(?:\s[^>]*)?>(.*?)</{re.escape(tag)}>", text, re.DOTALL)
    if not found:
        raise UsageFault(f"{file} has no tag {tag!r}")
    output.lines(word.strip() for word in found)
    return exits.OK


pkg.add_command(create)
