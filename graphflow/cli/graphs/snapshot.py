"""`graphflow snapshot`: save turtlesim's drawing as a picture."""

from __future__ import annotations

from pathlib import Path

import click

from graphflow.cli import exits, output
from graphflow.domain import domain_id
from graphflow.errors import CallError, UsageFault
from graphflow.introspect.graph_view import View
from graphflow.wire.liveliness import Kind

SERVICE = "std_srvs/srv/Trigger"
LIMIT = 10.0
"""Seconds that the simulator has to draw."""


@click.command()
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path), default="turtlesim.svg")
@click.option("--node", help="The simulator, if there are several.")
def snapshot(file: Path, node: str | None) -> int:
    """Save turtlesim's drawing as an SVG picture in FILE. [turtlesim.svg]"""
    from graphflow.msgs import registry

    if file.suffix != ".svg":
        raise UsageFault(f"{file}: the picture is an SVG file; name it {file.with_suffix('.svg')}")
    with View(domain_id()) as view:
        wanted = view.node(node) if node else None
        found = [
            e
            for e in view.cache.endpoints(Kind.SERVICE)
            if e.name == f"{e.node_name}/snapshot" and e.type == SERVICE and wanted in (None, e.node_name)
        ]
        if not found:
            what = f"{wanted} draws nothing" if wanted else "no running node draws anything"
            raise CallError(f"{what}; start turtlesim: graphflow up turtlesim")
        if len(found) > 1:
            names = ", ".join(e.node_name for e in found)
            raise UsageFault(f"several nodes draw: {names}; choose one with --node")
        response = view.call(found[0].name, SERVICE, registry.interface_class(f"{SERVICE}_Request")(), LIMIT)
    if not response.success:
        raise CallError(f"{found[0].node_name} did not draw: {response.message}")
    file.write_text(response.message, encoding="utf-8")
    output.data(str(file))
    return exits.OK
