"""`graphflow pkg list`, `executables`, `prefix`, `xml` and `create`: ROS 2's words for what a project has."""

from __future__ import annotations

import os
import re
from pathlib import Path

import click

from graphflow.cli import exits, output
from graphflow.cli.types import use_project
from graphflow.cli.verbs import Verbs
from graphflow.errors import UsageFault
from graphflow.names import did_you_mean


@click.group(cls=Verbs)
def pkg() -> None:
    """List packages and what is in them, or make one."""


def _root() -> Path:
    from graphflow.graph.project import project_root

    return project_root(Path.cwd())


def _known() -> list[str]:
    """Packages of nodes that come with graphflow, of the project, and those that have types."""
    from graphflow.graph.executables import project_packages, with_graphflow
    from graphflow.msgs import registry

    use_project()
    return sorted({package for package, _ in with_graphflow()} | {*project_packages(_root()), *registry.packages()})


@pkg.command("list")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def list_(as_json: bool) -> None:
    """List the packages that are known here."""
    output.listing(_known(), json=as_json)


@pkg.command()
@click.argument("package", default="")
@click.option("--full-path", is_flag=True, help="Where each is.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def executables(package: str, full_path: bool, as_json: bool) -> int:
    """List what `graphflow run PACKAGE EXECUTABLE` can start."""
    from graphflow.graph.executables import all_executables

    rows = [row for row in all_executables(_root()) if package in ("", row.package)]
    if not rows and package in _known():
        output.talk(f"the package {package!r} has no executable that graphflow can run")
        return exits.OK
    if not rows:
        output.error(f"Package '{package}' not found{did_you_mean(package, _known())}")
        return exits.FAILED
    if as_json:
        output.as_json([{"package": r.package, "name": r.name, "class": r.class_path} for r in rows])
        return exits.OK
    for row in rows:
        where = row.class_path.partition(":")[0].replace(".", "/")
        output.data(f"{where}.py" if full_path else f"{row.package} {row.name}" if not package else row.name)
    return exits.OK


@pkg.command()
@click.argument("package")
@click.option("--share", is_flag=True, help="The folder of its files.")
def prefix(package: str, share: bool) -> int:
    """Print where a package is."""
    from graphflow.graph.executables import EXECUTABLES, package_prefix, package_share
    from graphflow.graph.project import demos_root

    found = (package_share if share else package_prefix)(package, _root(), os.environ)
    if found is None and any(package == known for known, _ in EXECUTABLES):
        found = demos_root()
    if found is None:
        output.error(f"Package not found{did_you_mean(package, _known())}")
        return exits.FAILED
    output.data(str(found))
    return exits.OK


@pkg.command()
@click.argument("package")
@click.option("-t", "--tag", help="Only what this tag has.")
def xml(package: str, tag: str | None) -> int:
    """Print a package's package.xml."""
    from graphflow.graph.executables import package_share

    folder = package_share(package, _root(), os.environ)
    file = folder / "package.xml" if folder is not None else None
    if file is None or not file.is_file():
        output.error(f"{package}: no package.xml was found{did_you_mean(package, _known())}")
        return exits.FAILED
    text = file.read_text(encoding="utf-8", errors="replace")
    if tag is None:
        output.data(text.rstrip("\n"))
        return exits.OK
    found = re.findall(rf"<{re.escape(tag)}(?:\s[^>]*)?>(.*?)</{re.escape(tag)}>", text, re.DOTALL)
    if not found:
        raise UsageFault(f"{file} has no tag {tag!r}")
    output.lines(word.strip() for word in found)
    return exits.OK


@pkg.command()
@click.argument("name")
@click.option("--destination-directory", type=click.Path(path_type=Path), default=Path(), help="Where to make it. [.]")
@click.option("--node-name", help="For ROS 2's commands: the project has a first node.")
@click.option("--build-type", help="For ROS 2's commands: nothing is built.")
@click.option("--dependencies", multiple=True, help="For ROS 2's commands: what is installed can be imported.")
@click.option("--library-name", help="For ROS 2's commands: nothing is built.")
@click.option("--package-format", help="For ROS 2's commands.")
@click.option("--description", help="For ROS 2's commands.")
@click.option("--license", "license_", help="For ROS 2's commands.")
@click.option("--maintainer-email", help="For ROS 2's commands.")
@click.option("--maintainer-name", help="For ROS 2's commands.")
@click.argument("more", nargs=-1)
def create(name: str, destination_directory: Path, **unused: object) -> None:
    """Write a starter project, as `graphflow init NAME` does; ROS 2's options are taken, and not needed."""
    from graphflow.cli.init import check_new, written

    folder = destination_directory / name
    check_new(folder)
    output.data("going to create a new package")
    output.data(f"package name: {name}")
    output.data(f"destination directory: {destination_directory.resolve()}")
    output.data(f"creating folder {_dotted(folder)}")
    output.lines(f"creating {_dotted(file)}" for file in written(folder))
    if any(unused.values()):
        output.talk("note: there is no build type and no list of dependencies; nothing is built")
    output.talk(f"next:\n  cd {folder}\n  graphflow up graphs/{name}.yaml")


def _dotted(path: Path) -> str:
    """A path as ROS 2 tells it: `./my_package`."""
    return str(path) if path.is_absolute() else f"./{path}"
