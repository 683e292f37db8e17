"""`graphflow run MODULE:CLASS`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from graphflow.cli import output
from graphflow.errors import GraphflowError, NoModule, UsageFault

if TYPE_CHECKING:
    from graphflow.runtime.node import Node


@click.command(context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False})
@click.argument("class_path", metavar="MODULE:CLASS")
@click.argument("words", nargs=-1, type=click.UNPROCESSED)
def run(class_path: str, words: tuple[str, ...]) -> None:
    """Run one node: `graphflow run nodes.talker:Talker --ros-args -r chatter:=news -p rate:=2.0`.

    \b
    -r from:=to     remap a name; __node:=NAME and __ns:=/NAMESPACE rename the node
    -p name:=value  set a parameter
    """  # noqa: D301 - click wants the character
    from graphflow.domain import domain_id
    from graphflow.introspect.view import refuse_taken_names
    from graphflow.names import Resolver
    from graphflow.runtime.args import parse_ros_args
    from graphflow.runtime.run import run as run_node

    if ":" not in class_path:
        raise UsageFault(f"{class_path!r}: write MODULE:CLASS, for example nodes.talker:Talker")
    try:
        ros = parse_ros_args(words)
    except GraphflowError as error:
        raise UsageFault(str(error)) from None
    cls = _import(class_path)
    names = Resolver(cls.interface().node_name, "/", ros.remaps)
    refuse_taken_names([names.full_name], domain_id(), hint="give this one another name with -r __node:=NAME")
    run_node(cls, args=words)


def _import(class_path: str) -> type[Node]:
    """The class, from the project around the working directory or else from those that come with graphflow."""
    from inspect import getfile

    from graphflow.graph.project import demos_root, project_root
    from graphflow.supervisor.classes import add_root, import_class

    root = project_root(Path.cwd())
    add_root(str(root))
    try:
        try:
            cls = import_class(class_path)
        except NoModule as error:
            # A project's own `nodes` is never mixed with ours: only where there is none do ours stand in for it.
            if error.module != "nodes":
                raise
            add_root(str(demos_root()))
            cls = import_class(class_path)
    except GraphflowError as error:
        raise UsageFault(str(error)) from None
    if root != demos_root() and Path(getfile(cls)).is_relative_to(demos_root()):
        output.talk(f"{class_path}: using the one that comes with graphflow, {getfile(cls)}")
    return cls
