"""`graphflow graph`: draw the running graph."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import click

from graphflow.cli import exits, output
from graphflow.domain import domain_id
from graphflow.errors import CallError
from graphflow.introspect.empty_hint import nothing_here
from graphflow.introspect.graph_view import View
from graphflow.names import did_you_mean

if TYPE_CHECKING:
    from graphflow.introspect.drawing.layered import Cell, Drawing
    from graphflow.introspect.drawing.picture import Picture

PNG_LIMIT = 60.0
"""Seconds that Graphviz may take."""


@click.command()
@click.argument("namespace", default="")
@click.option("-a", "--all", "everything", is_flag=True, help="Include unconnected topics and those of every node.")
@click.option("--dot", "form", flag_value="dot", help="Print Graphviz source.")
@click.option("--mermaid", "form", flag_value="mermaid", help="Print Mermaid source.")
@click.option("--json", "form", flag_value="json", help="Print JSON.")
@click.option("--svg", type=click.Path(dir_okay=False, path_type=Path), help="Write an SVG file.")
@click.option("--png", type=click.Path(dir_okay=False, path_type=Path), help="Write a PNG file, drawn by Graphviz.")
def graph(namespace: str, everything: bool, form: str | None, svg: Path | None, png: Path | None) -> int:
    """Draw the running nodes and topics, all or those of a NAMESPACE. Incompatible connections are marked."""
    from graphflow.introspect.drawing.picture import dot, mermaid
    from graphflow.introspect.drawing.picture import picture as picture_of

    below = namespace and f"/{namespace.strip('/')}"
    with View(domain_id()) as view:
        picture = picture_of(view.cache, below, frozenset(), everything=everything)
        known = view.cache.nodes(hidden=False)
    if not picture.nodes:
        if below and known:
            near = did_you_mean(below, {*known, *(node.rpartition("/")[0] for node in known)} - {""})
            raise CallError(f"there is no node {below}, and none below that name{near}")
        output.talk(nothing_here("no nodes"))
        return exits.OK
    if png is not None:
        return _png(dot(picture), png)
    if svg is not None:
        return _svg(picture, svg)
    if form == "json":
        arrows = [{"source": a.source, "target": a.target, "fits": not a.is_bad} for a in picture.arrows]
        output.as_json({"nodes": list(picture.nodes), "topics": list(picture.topics), "arrows": arrows})
        return exits.OK
    if form is not None:
        output.data(dot(picture) if form == "dot" else mermaid(picture))
        return exits.OK
    output.lines("".join(cell.text for cell in row).rstrip() for row in _drawn(picture).rows)
    bad = sorted({a.source for a in picture.arrows if a.is_bad} & set(picture.topics))
    output.lines(f"! {topic} is incompatible: graphflow topic info -v {topic}" for topic in bad)
    return exits.OK


def _drawn(picture: Picture) -> Drawing:
    from graphflow.introspect.drawing.layered import Box, draw

    bad = {arrow.source for arrow in picture.arrows if arrow.is_bad}
    boxes = {node: Box((node,)) for node in picture.nodes}
    boxes |= {topic: Box((f"! {topic}" if topic in bad else topic,), False) for topic in picture.topics}
    return draw(boxes, ((arrow.source, arrow.target) for arrow in picture.arrows))


def _svg(picture: Picture, file: Path) -> int:
    try:
        file.write_text(output.svg(_coloured(picture), "graphflow graph"), encoding="utf-8")
    except OSError as error:
        output.error(f"{file}: {error.strerror}")
        return exits.FAILED
    output.data(str(file))
    return exits.OK


def _coloured(picture: Picture) -> Iterator[list[tuple[str, str]]]:
    """Yield the rows of the drawing as texts with their styles."""
    bad = {arrow.source for arrow in picture.arrows if arrow.is_bad}

    def style(cell: Cell) -> str:
        if (cell.box or cell.arrow) in bad and cell.box not in picture.nodes:
            return "red"
        return "bold cyan" if cell.box in picture.nodes else "white"

    for row in _drawn(picture).rows:
        yield [("".join(cell.text for cell in run), name) for name, run in groupby(row, style)]


def _png(text: str, file: Path) -> int:
    program = shutil.which("dot")
    if program is None:
        output.error("PNG files are drawn by Graphviz, which is not installed; --svg FILE needs no other program")
        return exits.FAILED
    words = [program, "-Tpng", "-o", str(file)]
    done = subprocess.run(words, input=text, text=True, capture_output=True, timeout=PNG_LIMIT, check=False)
    if done.returncode:
        output.error(f"{file}: {done.stderr.strip()}")
        return exits.FAILED
    output.data(str(file))
    return exits.OK
