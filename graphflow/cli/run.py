"""`graphflow run MODULE:CLASS`."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from graphflow.cli import output
from graphflow.cli.exits import UsageFault


@click.command(context_settings={"ignore_unknown_options": True, "allow_interspersed_args": False})
@click.argument("class_path", metavar="MODULE:CLASS")
@click.argument("words", nargs=-1, type=click.UNPROCESSED)
def run(class_path: str, words: tuple[str, ...]) -> None:
    """Run one node: `graphflow run nodes.talker:Talker --ros-args -r chatter:=news -p rate:=2.0`.

    \b
    -r from:=to     remap a name; __node:=NAME and __ns:=/NAMESPACE rename the node
    -p name:=value  set a parameter
    """  # noqa: D301 - click wants the character
    from graphflow.errors import GraphflowError
    from graphflow.graph.project import demos_root, project_root
    from graphflow.runtime.args import parse_ros_args
    from graphflow.runtime.run import run as run_node
    from graphflow.supervisor.worker import import_class

    if ":" not in class_path:
        raise UsageFault(f"{class_path!r}: write MODULE:CLASS, for example nodes.talker:Talker")
    parse_ros_args(words)
    root = project_root(Path.cwd())
    sys.path.append(str(root))
    try:
        cls = import_class(class_path)
    except GraphflowError as error:
        if not str(error).endswith("there is no module 'nodes'") and root != demos_root():
            raise UsageFault(str(error)) from None
        sys.path.append(str(demos_root()))
        try:
            cls = import_class(class_path)
        except GraphflowError:
            raise UsageFault(str(error)) from None
        output.talk(f"{class_path} is one that comes with graphflow: {demos_root()}")
    run_node(cls, args=words)
