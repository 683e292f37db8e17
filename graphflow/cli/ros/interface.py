"""`graphflow interface show`, `proto`, `list`, `package`, `packages` and `stubs`."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TypeVar

import click

from graphflow.cli import exits, output
from graphflow.cli.messages.types import use_project
from graphflow.cli.verbs import Verb, Verbs
from graphflow.domain import domain_id
from graphflow.errors import GraphflowError, SupervisorError, UnknownInterface, UsageFault
from graphflow.introspect.graph_view import View
from graphflow.names import did_you_mean

F = TypeVar("F", bound=Callable[..., object])


@click.group(cls=Verbs)
def interface() -> None:
    """Show message, service and action types."""


def _kinds(command: F) -> F:
    """Add the options that choose the kind of types to a command."""
    command = click.option("-a", "--only-actions", "only", flag_value="action", help="List actions only.")(command)
    command = click.option("-s", "--only-srvs", "only", flag_value="srv", help="List services only.")(command)
    return click.option("-m", "--only-msgs", "only", flag_value="msg", help="List messages only.")(command)


class _Show(Verb):
    """A verb of one type, which joins a package and a name that were given as two words."""

    def one_too_many(self, ctx: click.Context, left: Sequence[str]) -> str:
        from graphflow.msgs import registry

        use_project()
        package, name = ctx.params["type_name"], left[0]
        kinds = [kind for kind in registry.KINDS if name in registry.names_in(package, kind)]
        if len(left) == 1 and kinds:
            return f"a type is one word: graphflow interface show {package}/{kinds[0]}/{name}"
        return super().one_too_many(ctx, left)


@interface.command(cls=_Show)
@click.argument("type_name", metavar="TYPE")
@click.option("--all-comments", is_flag=True, help="Show comments of nested types, too.")
@click.option("--no-comments", is_flag=True, help="Leave out comments and empty lines.")
def show(type_name: str, all_comments: bool, no_comments: bool) -> None:
    """Show the definition of a type. Fields of nested types are indented below; `-` reads the type from standard input.

    Your own definitions are shown with their comments; those that come with graphflow have none.
    """
    from graphflow.msgs import registry
    from graphflow.wire.idl import without_comment

    use_project()
    if type_name == "-":
        type_name = sys.stdin.readline().strip()
    try:
        name = registry.full_name(_of_name(type_name))
        registry.interface(name)
    except UnknownInterface as error:
        if instead := _instead(type_name):
            raise UsageFault(instead) from None
        raise error
    package = name.partition("/")[0]
    for line in registry.definition(name).splitlines():
        text = without_comment(line).rstrip() if no_comments else line
        if no_comments and not text:
            continue
        output.data(text)
        output.lines(_nested(text, package, 1, all_comments and not no_comments))


def _instead(word: str) -> str:
    """Return the error text for a word that is a package or a field of a type; empty for other words."""
    from graphflow.msgs import registry

    if registry.package_folders(word):
        return f"{word} is a package: graphflow interface package {word} lists its types"
    found = re.fullmatch(r"((?:[a-z]\w*[./])*[A-Z]\w*)[./]([a-z][\w./]*)", word)
    if found is None:
        return ""
    head, fields = found[1], re.split("[./]", found[2])
    names = [head] if re.search("[./]", head) else registry.having(head)
    if len(names) != 1:
        return ""
    try:
        name = registry.full_name(names[0])
        schema = registry.message_schema(name)
        for part in fields:
            field = next(field for field in schema.fields if field.name == part)
            if field.type.is_primitive:
                return f"{'.'.join(fields)} of {name} is {field.type}; whole type: graphflow interface show {name}"
            schema = registry.message_schema(field.type.base)
    except (GraphflowError, StopIteration):
        return ""
    return f"{'.'.join(fields)} of {name} is {schema.name}: graphflow interface show {schema.name}"


def _of_name(word: str) -> str:
    """Return the word, unless it is the name of a topic, service or action of the graph.

    Raises:
        UsageFault: It is; the text has the command for its type.
    """
    if not word.startswith("/"):
        return word
    try:
        with View(domain_id()) as view:
            tables = (view.cache.topics(hidden=True), view.cache.services(hidden=True), view.cache.actions())
    except SupervisorError:  # no graph is running
        return word
    for type_name in (type_ for names in tables for type_ in names.get(word, [])):
        raise UsageFault(f"{word} is not a type; to show its type: graphflow interface show {type_name}")
    return word


@interface.command("list")
@_kinds
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def list_(only: str | None, as_json: bool) -> None:
    """List all types, including the project's own."""
    from graphflow.msgs import registry

    use_project()
    heads = {"msg": "Messages:", "srv": "Services:", "action": "Actions:"}
    kinds = [only] if only else heads
    found = {k: [f"{p}/{k}/{n}" for p in registry.packages() for n in registry.names_in(p, k)] for k in kinds}
    if as_json:
        output.as_json(found)
        return
    for kind, names in found.items():
        output.lines([heads[kind], *(f"    {name}" for name in names)])


interface.add_command(show, "info")


@interface.command()
@click.argument("type_name", metavar="TYPE")
@click.option("--no-quotes", is_flag=True, help="Leave out the quotes around the message.")
def proto(type_name: str, no_quotes: bool) -> None:
    """Print a message with all its fields, to be filled in. Of a service it is the request, of an action the goal."""
    from graphflow.introspect.messages.echo import block, plain
    from graphflow.msgs import registry

    use_project()
    text = block(plain(registry.prototype(registry.full_name(type_name))))
    output.data(text if no_quotes else f'"{text}\n"')


@interface.command()
@click.argument("name", metavar="[PACKAGE]", default="")
@_kinds
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def package(name: str, only: str | None, as_json: bool) -> None:
    """List the types of a package; without PACKAGE, the packages."""
    from graphflow.msgs import registry

    use_project()
    if not name:
        output.listing(registry.packages(), json=as_json)
        output.talk("to list the types of one: graphflow interface package PACKAGE")
        return
    if not registry.package_folders(name):
        hint = registry.no_kinds(name) or did_you_mean(name, registry.packages())
        raise UsageFault(f"there is no interface package {name!r}{hint}")
    kinds = (only,) if only else registry.KINDS
    output.listing((f"{name}/{kind}/{n}" for kind in kinds for n in registry.names_in(name, kind)), json=as_json)


@interface.command()
@_kinds
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def packages(only: str | None, as_json: bool) -> None:
    """List the packages that have types."""
    from graphflow.msgs import registry

    use_project()
    kinds = (only,) if only else registry.KINDS
    found = [p for p in registry.packages() if any(registry.names_in(p, kind) for kind in kinds)]
    output.listing(found, json=as_json)


@interface.command()
@click.option("--output", "-o", "folder", default="typings", show_default=True, help="Folder in the project.")
def stubs(folder: str) -> int:
    """Write stubs of your types for editors and type checkers. Repeat after changing a type."""
    from graphflow.msgs import registry
    from graphflow.msgs import stubs as writer
    from graphflow.rclpy.messages.stubs import stubs as ros_stubs
    from graphflow.workspace.packages import find_workspace
    from graphflow.workspace.project import project_root, shown

    root = project_root(Path.cwd())
    use_project()
    files = writer.project_stubs(root / "interfaces", root / folder)
    workspace = find_workspace(Path.cwd())
    files |= ros_stubs(workspace.interfaces, (workspace.root if workspace.interfaces else root) / folder)
    if not files:
        where = f"{root / 'interfaces'} has no PACKAGE/msg, PACKAGE/srv or PACKAGE/action with definitions"
        raise UsageFault(f"{where}, and there is no package of a workspace")
    try:
        writer.write(files)
    except OSError as error:
        output.error(f"{error.filename}: {error.strerror}")
        return exits.FAILED
    output.lines(shown(file) for file in files if file.parent.name in registry.KINDS)
    if folder == "typings":
        output.talk('editors find them there; mypy needs this in pyproject.toml: [tool.mypy] mypy_path = "typings"')
    return exits.OK


def _nested(line: str, package: str, depth: int, has_comments: bool) -> Iterator[str]:
    """Yield the definition of the type of a field, indented, with those of nested types below."""
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
    inner = type_.base.partition("/")[0]
    registry.message_schema(type_.base)  # raises for a type that contains itself, which would recurse for ever
    for text in registry.definition(type_.base).splitlines():
        shown = text.rstrip() if has_comments else idl.without_comment(text).rstrip()
        if shown or has_comments:
            yield "\t" * depth + shown if shown else ""
        yield from _nested(text, inner, depth + 1, has_comments)
