"""`graphflow plan`, `check`, `explain` and `schema`: graph files without running them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Sized
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from graphflow.cli import exits, output
from graphflow.errors import UsageFault
from graphflow.names import did_you_mean
from graphflow.reading import found_bytes

if TYPE_CHECKING:
    from graphflow.errors import Place, Problem
    from graphflow.graph.check import Interfaces
    from graphflow.graph.plan import Plan


def find_graph(text: str) -> Path:
    """The file that `up NAME` means: a path, or the name of a graph that is installed or comes with graphflow.

    Raises:
        UsageFault: `text` is neither.
    """
    path = Path(text)
    if path.is_file():
        return path
    from graphflow.graph import installed
    from graphflow.graph.project import bundled_graphs

    name, bundled, others = text.removesuffix(".yaml"), bundled_graphs(), installed.graphs()
    found = others.get(name) or ([bundled[name]] if name in bundled else [])
    if len(found) == 1:
        source = "an installed package" if name in others else "graphflow"
        output.talk(f"{text}: using the one that comes with {source}, {found[0]}")
        return found[0]
    if found:
        raise UsageFault(f"several packages have a graph {name!r}; name its file: {', '.join(map(str, found))}")
    folder = path if path.is_dir() else path.parent
    near = [str(p) for p in (*folder.glob("*.yaml"), *Path("graphs").glob("*.yaml"))]
    what = "is a folder" if path.is_dir() else "there is no such file"
    raise UsageFault(f"{text}: {what}{did_you_mean(text, [*near, *bundled, *others])}")


_graph = click.argument("graph", metavar="GRAPH.yaml")
_graph_or_source = click.argument("graph", metavar="GRAPH.yaml|FILE.py|FOLDER")
_args = click.argument("args", nargs=-1, metavar="[NAME:=VALUE]...")
_json = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


@click.command()
@_graph
@_args
@_json
@click.option("--diff", "other", metavar="OTHER.yaml", help="Show what would be different in another file.")
def plan(graph: str, args: tuple[str, ...], as_json: bool, other: str | None) -> None:
    """Show exactly what a graph file would run and where each setting comes from. Imports nothing.

    A launch file in Python is run for that, in a process of its own.
    """
    path = find_graph(graph)
    from graphflow.graph.resolve import load
    from graphflow.supervisor.launch_python import described

    resolved = load(path, args, describe=described)
    if other is not None:
        output.lines(_difference(resolved, load(find_graph(other), args, describe=described)))
    elif as_json:
        output.as_json(resolved.to_json())
    else:
        output.lines(resolved.lines())


def _difference(one: Plan, other: Plan) -> Iterator[str]:
    """Two plans as a unified diff, without the places of settings."""
    from difflib import unified_diff

    ours, theirs = ([line.partition("  # ")[0] for line in list(plan.lines())[1:]] for plan in (one, other))
    yield from unified_diff(ours, theirs, one.file, other.file, lineterm="", n=2)


@click.command()
@_graph_or_source
@_args
@_json
def check(graph: str, args: tuple[str, ...], as_json: bool) -> int:
    """Report every mistake in a graph file and in what it names. Node classes are imported, nothing is started.

    Deadlocks visible in the source are reported too: CERTAIN (exit code 1), IF THIS BRANCH RUNS, or POSSIBLE. Of a
    Python file or a folder, the nodes that are written for rclpy are read, and nothing is imported. A launch file in
    Python is run, in a process of its own.
    """
    if graph.endswith(".py") and not _is_launch_file(Path(graph)):
        return _check_rclpy([Path(graph), *map(Path, args)], as_json=as_json)
    try:
        path = find_graph(graph)
    except UsageFault:
        if not Path(graph).is_dir() or not _has_rclpy(Path(graph)):
            raise
        return _check_rclpy([Path(graph), *map(Path, args)], as_json=as_json)
    from graphflow.errors import GraphFileError
    from graphflow.graph.static import findings

    try:
        resolved, found = _checked(path, args)
    except GraphFileError as error:
        problems = sorted(error.problems)
        if as_json:
            output.as_json({"problems": [_problem(problem) for problem in problems], "deadlocks": []})
        else:
            output_problems(problems)
        return exits.USAGE
    ways = findings(resolved, found)
    certain = [way for way in ways if way.grade == "CERTAIN"]
    if as_json:
        deadlocks = [{"grade": way.grade, "text": str(way), **_place(way.place)} for way in ways]
        output.as_json({"problems": [], "deadlocks": deadlocks})
        return exits.FAILED if certain else exits.OK
    for text in (*resolved.remarks, *ways):
        output.talk(str(text))
    possible = [way for way in ways if way.grade in ("POSSIBLE", "IF THIS BRANCH RUNS")]
    told = [_count(certain, "deadlock")] * bool(certain) + [_count(possible, "possible deadlock")] * bool(possible)
    more = f"no mistakes, {', '.join(told)}" if told else "no problems"
    output.data(f"{path}: {_count(resolved.nodes, 'node')}, {_count(resolved.steps, 'step')}, {more}")
    return exits.FAILED if certain else exits.OK


def _is_launch_file(file: Path) -> bool:
    """Whether a Python file is a launch file of ROS's."""
    named = file.name.endswith((".launch.py", "_launch.py"))
    return file.is_file() and (named or b"def generate_launch_description" in found_bytes(file))


def _has_rclpy(folder: Path) -> bool:
    """Whether some code below a folder is written for rclpy."""
    from graphflow.graph.rclpy_source import files_in
    from graphflow.graph.workspace import uses_ros

    return any(map(uses_ros, files_in(folder)))


def _check_rclpy(paths: Sequence[Path], *, as_json: bool) -> int:
    """Report deadlocks that the source of rclpy nodes shows, of files and of all below folders."""
    from graphflow.graph.rclpy_source import findings_in

    for path in paths:
        if not path.exists():
            raise UsageFault(f"there is no file {path}")
    ways = [way for path in paths for way in findings_in(path)]
    certain = [way for way in ways if way.grade == "CERTAIN"]
    if as_json:
        deadlocks = [{"grade": way.grade, "text": str(way), **_place(way.place)} for way in ways]
        output.as_json({"problems": [], "deadlocks": deadlocks})
    else:
        output.lines(str(way) for way in ways)
        count = _count(ways, "deadlock")
        what = paths[0] if len(paths) == 1 else f"{len(paths)} paths"
        output.data(f"{what}: {f'{count} in the source' if ways else 'no deadlocks to be seen in the source'}")
    return exits.FAILED if certain else exits.OK


def _checked(path: Path, args: Sequence[str]) -> tuple[Plan, Interfaces]:
    """A graph and what its classes declare.

    Raises:
        GraphFileError: Every mistake that was found.
    """
    from graphflow.errors import GraphFileError
    from graphflow.graph.check import check as check_plan
    from graphflow.graph.project import add_interfaces
    from graphflow.graph.resolve import load
    from graphflow.supervisor.classes import read_interfaces
    from graphflow.supervisor.launch_python import described
    from graphflow.supervisor.probe import probe

    resolved = load(path, args, describe=described)
    add_interfaces(Path(resolved.root))
    found = read_interfaces(probe(resolved.classes(), resolved.root))
    problems = check_plan(resolved, found)
    if problems:
        raise GraphFileError(problems)
    return resolved, found


def output_problems(problems: Sequence[Problem]) -> None:
    """Say what is wrong with a graph file."""
    for problem in problems:
        output.talk(str(problem))
    output.talk(_count(problems, "problem"))


def _problem(problem: Problem) -> dict[str, Any]:
    return {"message": problem.message, **_place(problem.place)}


def _place(place: Place) -> dict[str, Any]:
    return {"file": place.file, "line": place.line, "column": place.column}


@click.command()
@_graph
@click.argument("name", required=False)
@_args
@_json
def explain(graph: str, name: str | None, args: tuple[str, ...], as_json: bool) -> None:
    """Explain how a name of a graph comes about: who uses it, by which namespace and rule.

    Without NAME, all names that the classes show.
    """
    from graphflow.graph import explain as explaining

    if name is not None and ":=" in name:
        args, name = (name, *args), None
    resolved, found = _checked(find_graph(graph), args)
    names = explaining.names(resolved, found)
    if name is not None:
        full = name if name.startswith("/") else f"/{name}"
        if full not in names:
            raise UsageFault(f"nothing in {graph} is called {full}{did_you_mean(full, names)}")
        names = {full: names[full]}
    if as_json:
        output.as_json(names)
        return
    for full, lines in sorted(names.items()):
        output.lines([full, *(f"  {line}" for line in lines)])


@click.command()
def schema() -> None:
    """Print the JSON Schema of graph files, with which an editor completes and checks them as you type.

    Save it, and begin a graph file with:  # yaml-language-server: $schema=graph.schema.json
    """
    from graphflow.graph.schema import schema_text

    output.data(schema_text().rstrip())


def _count(things: Sized, word: str) -> str:
    return f"{len(things)} {word}{'' if len(things) == 1 else 's'}"
