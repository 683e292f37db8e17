"""`graphflow plan` and `graphflow check`: graph files without running them."""

from __future__ import annotations

from collections.abc import Sized
from pathlib import Path

import click

from graphflow.cli import exits, output
from graphflow.errors import UsageFault
from graphflow.names import did_you_mean


def find_graph(text: str) -> Path:
    """The file that `up NAME` means: a path, or the name of a graph that comes with graphflow.

    Raises:
        UsageFault: `text` is neither.
    """
    path = Path(text)
    if path.is_file():
        return path
    from graphflow.graph.project import bundled_graphs

    bundled = bundled_graphs()
    if text.removesuffix(".yaml") in bundled:
        found = bundled[text.removesuffix(".yaml")]
        output.talk(f"{text}: using the one that comes with graphflow, {found}")
        return found
    folder = path if path.is_dir() else path.parent
    near = [str(p) for p in (*folder.glob("*.yaml"), *Path("graphs").glob("*.yaml"))]
    what = "is a folder" if path.is_dir() else "there is no such file"
    raise UsageFault(f"{text}: {what}{did_you_mean(text, [*near, *bundled])}")


@click.command()
@click.argument("graph", metavar="GRAPH.yaml")
@click.argument("args", nargs=-1, metavar="[NAME:=VALUE]...")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def plan(graph: str, args: tuple[str, ...], as_json: bool) -> None:
    """Show exactly what a graph file would run and where each setting comes from. Imports nothing."""
    path = find_graph(graph)
    from graphflow.graph.resolve import load

    resolved = load(path, args)
    if as_json:
        output.as_json(resolved.to_json())
    else:
        output.lines(resolved.lines())


@click.command()
@click.argument("graph", metavar="GRAPH.yaml")
@click.argument("args", nargs=-1, metavar="[NAME:=VALUE]...")
def check(graph: str, args: tuple[str, ...]) -> int:
    """Report every mistake in a graph file and in what it names. Node classes are imported, nothing is started.

    Deadlocks visible in the source are reported too: CERTAIN (exit code 1), IF THIS BRANCH RUNS, or POSSIBLE.
    """
    path = find_graph(graph)
    from graphflow.errors import GraphFileError
    from graphflow.graph.check import check as check_plan
    from graphflow.graph.project import add_interfaces
    from graphflow.graph.resolve import load
    from graphflow.supervisor.classes import read_interfaces
    from graphflow.supervisor.probe import probe

    try:
        resolved = load(path, args)
        add_interfaces(Path(resolved.root))
        found = read_interfaces(probe(resolved.classes(), resolved.root))
        problems = check_plan(resolved, found)
    except GraphFileError as error:
        problems = list(error.problems)
    for problem in sorted(problems):
        output.talk(str(problem))
    if problems:
        output.talk(_count(problems, "problem"))
        return exits.USAGE
    from graphflow.graph.static import findings

    ways = findings(resolved, found)
    for way in ways:
        output.talk(str(way))
    certain = [way for way in ways if way.grade == "CERTAIN"]
    possible = [way for way in ways if way.grade in ("POSSIBLE", "IF THIS BRANCH RUNS")]
    told = [_count(certain, "deadlock")] * bool(certain) + [_count(possible, "possible deadlock")] * bool(possible)
    more = f"no mistakes, {', '.join(told)}" if told else "no problems"
    output.data(f"{path}: {_count(resolved.nodes, 'node')}, {_count(resolved.steps, 'step')}, {more}")
    return exits.FAILED if certain else exits.OK


def _count(things: Sized, word: str) -> str:
    return f"{len(things)} {word}{'' if len(things) == 1 else 's'}"
