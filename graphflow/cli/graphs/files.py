"""`graphflow plan`, `check`, `explain` and `schema`: inspect graph files without running them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence, Sized
from pathlib import Path
from typing import TYPE_CHECKING

import click

from graphflow.cli import exits, output
from graphflow.cli.arguments import GraphCommand
from graphflow.errors import UsageFault
from graphflow.names import did_you_mean, nearest
from graphflow.reading import found_bytes

if TYPE_CHECKING:
    from graphflow.errors import Place, Problem
    from graphflow.graph.checks.check import Interfaces
    from graphflow.graph.plan import Plan


_SHOWN = 12
"""Most files of a folder that an error lists."""
_CLASS = re.compile(r"[^\W\d][\w.]*:[^\W\d]\w*")
"""A class as `graphflow run` takes it: `nodes.talker:Talker`."""


def find_graph(text: str) -> Path:
    """Find a graph file by its path, or by the name of a graph of the project, an installed package or graphflow.

    Raises:
        UsageFault: There is none.
    """
    path = Path(text)
    if path.is_file():
        if path.suffix == ".py" and not is_launch_file(path):
            _refuse_source(path)
        return path
    from graphflow.workspace import installed
    from graphflow.workspace.project import bundled_graphs, project_root, shown

    own = project_root(Path.cwd()) / "graphs" / f"{text.removesuffix('.yaml')}.yaml"
    if own.is_file():
        output.talk(f"{text}: using the project's, {shown(own)}")
        return Path(shown(own))
    name, bundled, others = text.removesuffix(".yaml"), bundled_graphs(), installed.graphs()
    found = others.get(name) or ([bundled[name]] if name in bundled else [])
    if len(found) == 1:
        source = "an installed package" if name in others else "graphflow"
        output.talk(f"{text}: using the one that comes with {source}, {found[0]}")
        return found[0]
    if found:
        raise UsageFault(f"several packages have a graph {name!r}; name its file: {', '.join(map(str, found))}")
    if path.exists() and not path.is_dir():
        raise UsageFault(f"{text}: it is not a regular file")
    _refuse_node(text)
    _refuse_package(text)
    folder = path if path.is_dir() else path.parent
    files = folder.glob("*.py") if path.suffix == ".py" else (*folder.glob("*.yaml"), *Path("graphs").glob("*.yaml"))
    near = {str(file): file.stem for file in files}
    what = "is a folder" if path.is_dir() else "there is no such file"
    if path.is_dir() and (inside := sorted(map(str, [*path.glob("*.yaml")] or path.rglob("*.yaml")))):
        raise UsageFault(f"{text}: is a folder; name one of its files: {', '.join(inside[:_SHOWN])}")
    known = [*near] if path.suffix == ".py" else [*near, *bundled, *others]
    hint = did_you_mean(text, known)
    if not hint and path.stem in {**bundled, **others}:
        hint = f"; one of that name comes with graphflow: graphflow up {path.stem}"
    raise UsageFault(f"{text}: {what}{hint or _without_suffix(path, near)}")


def _without_suffix(path: Path, near: Mapping[str, str]) -> str:
    """Suggest a file whose name without the suffix resembles that of a missing one.

    Args:
        near: The files to suggest, each with its name without the suffix.
    """
    stem = nearest(path.stem, near.values())
    return "" if stem is None else f"; did you mean {next(file for file in near if near[file] == stem)!r}?"


def _refuse_node(name: str) -> None:
    """Refuse the name of a node where a graph is expected.

    Raises:
        UsageFault: It names a node of the project or of graphflow; the text has the command that runs it.
    """
    from graphflow.workspace.executables import project_nodes
    from graphflow.workspace.project import demos_root, project_root

    if _CLASS.fullmatch(name):
        raise UsageFault(f"{name} is a node's class, not a graph file; run it with: graphflow run {name}")
    root = project_root(Path.cwd())
    files = [folder / "nodes" / f"{name}.py" for folder in (root, demos_root())]
    if name in project_nodes(root) or any(file.is_file() for file in files):
        raise UsageFault(f"{name!r} is a node, not a graph: graphflow run {name}")


def _refuse_package(text: str) -> None:
    """Refuse the name of a package, or of a launch file in one, where a graph is expected.

    Raises:
        UsageFault: It is one of a package of the workspace; the text has the command that starts it.
    """
    from graphflow.workspace.packages import find_workspace
    from graphflow.workspace.unfound import launching, starts_of

    packages = find_workspace(Path.cwd()).packages
    if way := launching(text, packages.values()):
        raise UsageFault(f"{text}: there is no such file{way}")
    if text in packages:
        raise UsageFault(f"{text} is a package, not a graph file{starts_of(packages[text])}")


def _refuse_source(file: Path) -> None:
    """Refuse a Python file with nodes where a graph is expected.

    Raises:
        UsageFault: It has nodes; the text has the command that runs one.
    """
    from graphflow.workspace.node_classes import node_classes_in
    from graphflow.workspace.source_kinds import uses_ros

    classes = [] if uses_ros(file) else list(node_classes_in(file))
    if not classes and not uses_ros(file):
        return
    from graphflow.workspace.project import module_of

    _, module = module_of(file)
    several = f"; it has {', '.join(classes)}" if len(classes) > 1 else ""
    run = f"graphflow run {f'{module}:{classes[0]}' if several else file}"
    entry = f"; in a graph file: nodes: {{/{classes[0].lower()}: {{class: {module}:{classes[0]}}}}}" if classes else ""
    raise UsageFault(f"{file} is a node, not a graph file{several}; run it with: {run}{entry}")


_graph = click.argument("graph", metavar="GRAPH.yaml")
_graph_or_source = click.argument("graph", metavar="GRAPH.yaml|FILE.py|FOLDER")
_args = click.argument("args", nargs=-1, metavar="[NAME:=VALUE]...")
_json = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


@click.command(cls=GraphCommand)
@_graph
@_args
@_json
@click.option("--diff", "other", metavar="OTHER.yaml", help="Show the differences to another graph file.")
def plan(graph: str, args: tuple[str, ...], as_json: bool, other: str | None) -> None:
    """Show exactly what a graph file would run and where each setting comes from, without importing anything.

    A Python launch file is executed for this, in a process of its own.
    """
    path = find_graph(graph)
    from graphflow.graph.resolve import load
    from graphflow.supervisor.launching.launch_python import described

    resolved = load(path, args, describe=described)
    if other is not None:
        output.lines(_difference(resolved, load(find_graph(other), args, describe=described)))
    elif as_json:
        output.as_json(resolved.to_json())
    else:
        output.lines(resolved.lines())


def _difference(one: Plan, other: Plan) -> Iterator[str]:
    """Compare two plans as a unified diff, without the places of settings."""
    from difflib import unified_diff

    ours, theirs = ([line.partition("  # ")[0] for line in list(plan.lines())[1:]] for plan in (one, other))
    yield from unified_diff(ours, theirs, one.file, other.file, lineterm="", n=2)


def _graph_meant(text: str) -> Path | None:
    """Find the graph file to check; None if `text` is source. A graph's name takes precedence over a folder without /.

    Raises:
        UsageFault: It is neither.
    """
    path = Path(text)
    if text.endswith(".py") and not is_launch_file(path):
        return None
    if path.is_dir() and "/" in text:
        return None
    try:
        found = find_graph(text)
        if path.is_dir():
            output.talk(f"to check the nodes of the folder: graphflow check ./{text}")
        return found
    except UsageFault:
        if path.is_dir():
            return None
        module = text.partition(":")[0]
        file = Path(module if module.endswith(".py") else f"{module.replace('.', '/')}.py")
        if file.is_file():
            raise UsageFault(f"{text}: to check source, name its file: graphflow check {file}") from None
        raise


@click.command(cls=GraphCommand)
@_graph_or_source
@_args
@_json
def check(graph: str, args: tuple[str, ...], as_json: bool) -> int:
    """Report every mistake in a graph file and in what it refers to. Node classes are imported; nothing is started.

    Deadlocks visible in the source are reported: CERTAIN (exit code 1), IF THIS BRANCH RUNS, or POSSIBLE. So are
    names that nothing in the graph provides, and mistakes in the source that Python does not report. Given a Python
    file or a folder, node classes are imported, and nodes written for rclpy are only read. A graph's programs are read
    if they are written for rclpy, and else counted. A Python launch file is executed in a process of its own. Files of
    parameters, and a package's setup.py, are checked, too.
    """
    _refuse_other_files(Path(graph))
    path = _graph_meant(graph)
    if path is None:
        from graphflow.cli.graphs.ros_files import check_setup
        from graphflow.cli.graphs.sources import check_sources

        if Path(graph).name == "setup.py" and Path(graph).is_file() and not args:
            return check_setup(Path(graph), as_json=as_json)
        return check_sources([Path(graph), *map(Path, args)], as_json=as_json)
    from graphflow.cli.graphs.ros_files import check_parameters, is_parameters

    if is_parameters(path) and not args:
        return check_parameters(path, as_json=as_json)
    from graphflow.analysis.deadlock_check import findings
    from graphflow.analysis.rclpy_check import findings_in
    from graphflow.cli.graphs.programs import sources
    from graphflow.cli.graphs.sources import rclpy_remarks
    from graphflow.errors import GraphFileError
    from graphflow.graph.checks.loose_ends import loose_ends

    try:
        resolved, found, slips = _checked(path, args)
    except GraphFileError as error:
        problems = sorted(error.problems)
        if as_json:
            output.as_json({"problems": [_problem(problem) for problem in problems], "remarks": [], "deadlocks": []})
        else:
            output_problems(problems)
        return exits.USAGE
    programs, unread = sources(resolved)
    ways = [*findings(resolved, found), *(way for program in programs for way in findings_in(program))]
    slips += [text for program in programs for text in rclpy_remarks(program)]
    remarks = [*resolved.remarks, *map(str, sorted(loose_ends(resolved, found))), *slips]
    certain = [way for way in ways if way.grade == "CERTAIN"]
    if as_json:
        deadlocks = [{"grade": way.grade, "text": str(way), **_place(way.place)} for way in ways]
        names = [node.name for node in unread]
        output.as_json({"problems": [], "remarks": remarks, "deadlocks": deadlocks, "unread": names})
        return exits.FAILED if certain else exits.OK
    for text in (*remarks, *ways):
        output.talk(str(text))
    possible = [way for way in ways if way.grade in ("POSSIBLE", "IF THIS BRANCH RUNS")]
    unresolved = [way for way in ways if way.grade == "unresolved"]
    counts = [
        _count(things, noun)
        for things, noun in (
            (certain, "deadlock"),
            (possible, "possible deadlock"),
            (unresolved, "unresolved call"),
            (remarks, "remark"),
        )
        if things
    ]
    more = ", ".join(counts) or "no problems"
    more += f", {_count(unread, 'program')} not checked" if unread else ""
    output.data(f"{path}: {_count(resolved.nodes, 'node')}, {_count(resolved.steps, 'step')}, {more}")
    return exits.FAILED if certain else exits.OK


def _refuse_other_files(file: Path) -> None:
    """Check that a file is of a kind that is checked.

    Raises:
        UsageFault: It is part of a package; the text has the command that checks it.
    """
    kind = file.suffix.removeprefix(".")
    if kind in ("msg", "srv", "action") and file.is_file():
        folder = file.resolve().parent
        name = f"{folder.parent.name}/{kind}/{file.stem}" if folder.name == kind else f"PACKAGE/{kind}/{file.stem}"
        raise UsageFault(f"{file} is an interface: graphflow interface show {name} reads it; graphflow ws checks all")
    if file.name in ("CMakeLists.txt", "package.xml", "setup.cfg") and file.is_file():
        raise UsageFault(f"{file} is part of a package: graphflow ws checks those of the workspace")


_DESCRIBING = b"def generate_launch_description", b"LaunchService"
"""Names that occur in a Python launch file: its function, or the class that runs a description."""


def is_launch_file(file: Path) -> bool:
    """Whether a Python file is a ROS launch file."""
    named = file.name.endswith((".launch.py", "_launch.py"))
    return file.is_file() and (named or any(word in found_bytes(file) for word in _DESCRIBING))


def _checked(path: Path, args: Sequence[str]) -> tuple[Plan, Interfaces, list[str]]:
    """Load and check a graph; return its plan, its classes' interfaces and the slips in their source.

    Raises:
        GraphFileError: With every mistake found.
    """
    from graphflow.errors import GraphFileError
    from graphflow.graph.checks.check import check as check_plan
    from graphflow.graph.resolve import load
    from graphflow.supervisor.launching.launch_python import described
    from graphflow.supervisor.launching.probe import probe
    from graphflow.supervisor.launching.probed import read_interfaces, slips_in
    from graphflow.workspace.project import add_interfaces

    resolved = load(path, args, describe=described)
    add_interfaces(Path(resolved.root))
    data = probe(resolved.classes(), resolved.root)
    found = read_interfaces(data)
    problems = check_plan(resolved, found)
    if problems:
        raise GraphFileError(problems)
    regrouped = {node.class_path for node in resolved.nodes if node.concurrency}
    return resolved, found, slips_in(data, regrouped)


def output_problems(problems: Sequence[Problem]) -> None:
    """Print the problems of a graph file and their number."""
    for problem in problems:
        output.talk(str(problem))
    output.talk(_count(problems, "problem"))


def _problem(problem: Problem) -> dict[str, object]:
    return {"message": problem.message, **_place(problem.place)}


def _place(place: Place) -> dict[str, object]:
    return {"file": place.file, "line": place.line, "column": place.column}


@click.command(cls=GraphCommand)
@_graph
@click.argument("name", required=False)
@_args
@_json
def explain(graph: str, name: str | None, args: tuple[str, ...], as_json: bool) -> None:
    """Explain how a name in a graph is resolved: who uses it, and which namespace and remap rule applied.

    Without NAME, all names that the node classes declare.
    """
    from graphflow.graph import explain as explaining

    if not Path(graph).exists() and (graph.startswith("/") or (name is not None and Path(name).is_file())):
        file = name if name is not None and ":=" not in name else "GRAPH.yaml"
        runs = "" if name is not None else f"; for a running graph: graphflow node info {graph} or topic info {graph}"
        raise UsageFault(f"the graph file comes first: graphflow explain {file} {graph}{runs}")
    if name is not None and ":=" in name:
        args, name = (name, *args), None
    resolved, found, _ = _checked(find_graph(graph), args)
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
    """Print the JSON Schema of graph files, by which editors complete and check them as you type.

    Save it, and begin a graph file with:  # yaml-language-server: $schema=graph.schema.json
    """
    from graphflow.graph.schema import schema_text

    output.data(schema_text().rstrip())


def _count(things: Sized, word: str) -> str:
    return f"{len(things)} {word}{'' if len(things) == 1 else 's'}"
