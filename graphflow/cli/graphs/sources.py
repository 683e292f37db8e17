"""`graphflow check FILE.py|FOLDER`: nodes in source, without a graph file."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from graphflow.analysis import deadlock_check
from graphflow.analysis.deadlock_check import Finding
from graphflow.analysis.rclpy_check import files_in, findings_in, unfollowed_in
from graphflow.cli import exits, output
from graphflow.errors import Place, Problem, UsageFault
from graphflow.graph.checks.check import check
from graphflow.graph.plan import Plan, PlannedNode
from graphflow.interface import Interface
from graphflow.reading import found_text
from graphflow.supervisor.launching.probe import probe
from graphflow.supervisor.launching.probed import read_interfaces, slips_in
from graphflow.workspace.node_classes import node_classes_in
from graphflow.workspace.packages import uses_ros
from graphflow.workspace.project import add_interfaces, module_of, shown


def check_sources(paths: Sequence[Path], *, as_json: bool) -> int:
    """Report mistakes of node classes and deadlocks that their source shows, of files and of all below folders.

    Classes of graphflow's are imported; what is written for rclpy is only read.

    Raises:
        UsageFault: There is no such file, or no node in any.
    """
    seen = _Seen()
    for path in paths:
        if not path.exists():
            raise UsageFault(f"there is no file {path}")
        for file in files_in(path):
            if (fault := _unreadable(file)) is not None:
                seen.problems.append(fault)
            elif uses_ros(file):
                seen.is_rclpy = True
                seen.ways += findings_in(file)
                seen.unfollowed += unfollowed_in(file)
            elif classes := node_classes_in(file):
                seen.nodes += len(classes)
                wrong, ways, slips = _checked(file, classes)
                seen.problems += wrong
                seen.slips += slips
                seen.ways += ways
    if not (seen.nodes or seen.is_rclpy or seen.problems):
        raise UsageFault(f"{' '.join(map(str, paths))}: no node in it, of graphflow or of rclpy{_graphs_in(paths)}")
    _tell(paths, seen, as_json=as_json)
    if seen.problems:
        return exits.USAGE
    return exits.FAILED if any(way.grade == "CERTAIN" for way in seen.ways) else exits.OK


@dataclass
class _Seen:
    """Findings in the source of nodes."""

    problems: list[Problem] = field(default_factory=list)
    ways: list[Finding] = field(default_factory=list)
    """Deadlocks."""
    slips: list[str] = field(default_factory=list)
    """What Python runs without a word, and was not meant."""
    unfollowed: list[Place] = field(default_factory=list)
    """Loops in rclpy callbacks that poll what their file does not show being set."""
    nodes: int = 0
    """Classes of graphflow's."""
    is_rclpy: bool = False
    """Whether some of it is written for rclpy."""


def _unreadable(file: Path) -> Problem | None:
    try:
        ast.parse(found_text(file))
    except SyntaxError as error:
        return Problem(Place(shown(file), error.lineno or 1, error.offset or 1), f"SyntaxError: {error.msg}")
    except (OSError, ValueError) as error:
        return Problem(Place(shown(file)), f"cannot be read: {error}")
    return None


def _checked(file: Path, classes: dict[str, int]) -> tuple[list[Problem], list[Finding], list[str]]:
    """Mistakes in the classes of a file, which are imported, deadlocks that a graph of them could have, and slips."""
    root, module = module_of(file)
    add_interfaces(root)
    lines = {f"{module}:{name}": line for name, line in classes.items()}
    data = probe(lines, str(root))
    interfaces = read_interfaces(data)
    nodes = []
    for class_path, line in lines.items():
        interface, place = interfaces[class_path], Place(shown(file), line, 1)
        name = interface.node_name if isinstance(interface, Interface) else class_path
        nodes.append(PlannedNode(f"/{name}", class_path, place, place))
    plan = Plan(module, shown(file), str(root), tuple(nodes))
    alone = [check(Plan(module, plan.file, plan.root, (node,)), interfaces) for node in nodes]
    # Calls to other nodes are known in a graph only.
    ways = [way for way in deadlock_check.findings(plan, interfaces) if way.grade != "unresolved"]
    # A module that cannot be imported is so for each of its classes.
    problems = {problem.message: problem for found in reversed(alone) for problem in found}
    return list(problems.values()), ways, slips_in(data)


def _tell(paths: Sequence[Path], seen: _Seen, *, as_json: bool) -> None:
    if as_json:
        deadlocks = [{"grade": way.grade, "text": str(way), **place_of(way.place)} for way in seen.ways]
        told = [{"message": problem.message, **place_of(problem.place)} for problem in seen.problems]
        unfollowed = [place_of(place) for place in seen.unfollowed]
        output.as_json({"problems": told, "remarks": seen.slips, "deadlocks": deadlocks, "unfollowed": unfollowed})
        return
    for problem in seen.problems:
        output.talk(str(problem))
    output.lines(seen.slips)
    output.lines(
        f"{place}: not analysed: a callback polls what this file does not show being set" for place in seen.unfollowed
    )
    output.lines(str(way) for way in seen.ways)
    what = paths[0] if len(paths) == 1 else f"{len(paths)} paths"
    output.data(f"{what}: {', '.join(_counts(seen))}")


def _counts(seen: _Seen) -> Iterator[str]:
    if seen.nodes:
        yield f"{seen.nodes} node class{'es' * (seen.nodes != 1)}"
    if seen.problems:
        yield _count(seen.problems, "problem")
    if seen.ways:
        yield f"{_count(seen.ways, 'deadlock')} in the source"
    if not seen.problems and not seen.ways:
        of_nodes = "no mistakes" if seen.slips else "no problems"
        yield of_nodes if seen.nodes else "no deadlocks to be seen in the source"
    if seen.slips:
        yield _count(seen.slips, "remark")
    if seen.unfollowed:
        yield f"{_count(seen.unfollowed, 'loop')} not analysed"


def _count(things: Sequence[object], word: str) -> str:
    return f"{len(things)} {word}{'s' * (len(things) != 1)}"


def place_of(place: Place) -> dict[str, str | int]:
    """A place as JSON."""
    return {"file": place.file, "line": place.line, "column": place.column}


def _graphs_in(paths: Sequence[Path]) -> str:
    near = sorted(str(file) for path in paths if path.is_dir() for file in path.glob("*.yaml"))
    return f"; its graph files are checked one by one: {', '.join(near[:5])}" if near else ""
