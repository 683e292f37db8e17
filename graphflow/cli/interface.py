"""`graphflow interface show`, `list`, `package`, `packages` and `stubs`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import click

from graphflow.cli import exits, output
from graphflow.cli.types import use_project
from graphflow.cli.verbs import Verbs
from graphflow.errors import UsageFault
from graphflow.names import did_you_mean


@click.group(cls=Verbs)
def interface() -> None:
    """Show message, service and action types."""


@interface.command()
@click.argument("type_name", metavar="TYPE")
@click.option("--no-comments", is_flag=True, help="Without comments.")
def show(type_name: str, no_comments: bool) -> None:
    """Show a definition, with the fields of nested types below each."""
    from graphflow.msgs import registry

    use_project()
    name = registry.full_name(type_name)
    registry.interface(name)
    package = name.partition("/")[0]
    for line in registry.definition(name).splitlines():
        text = line.partition("#")[0].rstrip() if no_comments else line
        if not text and line:
            continue
        output.data(text)
        output.lines(_nested(text, package, 1))


@interface.command("list")
@click.option("-m", "--only-msgs", "only", flag_value="msg", help="Messages only.")
@click.option("-s", "--only-srvs", "only", flag_value="srv", help="Services only.")
@click.option("-a", "--only-actions", "only", flag_value="action", help="Actions only.")
def list_(only: str | None) -> None:
    """List all types, the project's own too."""
    from graphflow.msgs import registry

    use_project()
    for kind, head in (("msg", "Messages:"), ("srv", "Services:"), ("action", "Actions:")):
        if only in (None, kind):
            names = [f"{p}/{kind}/{n}" for p in registry.packages() for n in registry.names_in(p, kind)]
            output.lines([head, *(f"    {name}" for name in names)])


@interface.command()
@click.argument("name", metavar="PACKAGE")
def package(name: str) -> None:
    """List the types of a package."""
    from graphflow.msgs import registry

    use_project()
    if not registry.package_folders(name):
        raise UsageFault(f"there is no interface package {name!r}{did_you_mean(name, registry.packages())}")
    output.lines(f"{name}/{kind}/{n}" for kind in registry.KINDS for n in registry.names_in(name, kind))


@interface.command()
def packages() -> None:
    """List the packages that have types."""
    from graphflow.msgs import registry

    use_project()
    output.lines(registry.packages())


@interface.command()
@click.option("--output", "-o", "folder", default="typings", show_default=True, help="Folder, in the project.")
def stubs(folder: str) -> int:
    """Write what editors and type checkers read about the project's own types. Repeat when a definition changes."""
    from graphflow.graph.project import project_root, shown
    from graphflow.msgs import registry
    from graphflow.msgs import stubs as writer

    root = project_root(Path.cwd())
    use_project()
    files = writer.project_stubs(root / "interfaces", root / folder)
    if not files:
        raise UsageFault(f"{root / 'interfaces'} has no PACKAGE/msg, PACKAGE/srv or PACKAGE/action with definitions")
    try:
        writer.write(files)
    except OSError as error:
        output.error(f"{error.filename}: {error.strerror}")
        return exits.FAILED
    output.lines(shown(file) for file in files if file.parent.name in registry.KINDS)
    if folder == "typings":
        output.talk('editors look there; mypy needs in pyproject.toml: [tool.mypy] mypy_path = "typings"')
    return exits.OK


def _nested(line: str, package: str, depth: int) -> Iterator[str]:
    """The fields of the type that a line names, indented, with those of their types below."""
    from graphflow.errors import InterfaceError
    from graphflow.msgs import registry
    from graphflow.wire import idl

    word = line.partition("#")[0].split()[:1]
    if not word or word == ["---"]:
        return
    try:
        type_ = idl.parse_type(word[0], package)
    except InterfaceError:
        return
    if type_.is_primitive:
        return
    schema = registry.message_schema(type_.base)
    inner = type_.base.partition("/")[0]
    for constant in schema.constants:
        yield "\t" * depth + f"{constant.type} {constant.name}={constant.value}"
    for field in schema.fields:
        short = str(field.type).replace(f"{inner}/msg/", "").replace("/msg/", "/")
        text = f"{short} {field.name}{f' {field.default}' if field.default is not None else ''}"
        yield "\t" * depth + text
        yield from _nested(str(field.type).replace("/msg/", "/"), inner, depth + 1)
