"""`graphflow interface show`."""

from __future__ import annotations

from collections.abc import Iterator

import click

from graphflow.cli import output
from graphflow.cli.types import use_project


@click.group()
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
    for line in registry.definition_file(name).read_text(encoding="utf-8").splitlines():
        text = line.partition("#")[0].rstrip() if no_comments else line
        if not text and line:
            continue
        output.data(text)
        output.lines(_nested(text, package, 1))


def _nested(line: str, package: str, depth: int) -> Iterator[str]:
    """The fields of the type that a line names, indented, and those of their types below them."""
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
