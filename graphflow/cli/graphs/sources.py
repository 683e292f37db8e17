"""`graphflow check FILE.py|FOLDER`: check the source of nodes without a graph file."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from graphflow.analysis import deadlock_check
from graphflow.analysis.deadlock_check import Finding
from graphflow.analysis.hyphens import hyphen_hint
from graphflow.analysis.mistakes import rclpy_source
from graphflow.analysis.rclpy_check import files_in, findings_in, unfollowed_in
from graphflow.analysis.uncalled import named_only
from graphflow.cli import exits, output
from graphflow.errors import Place, Problem, UsageFault
from graphflow.graph.checks.check import check
from graphflow.graph.plan import Plan, PlannedNode
from graphflow.interface import Interface
from graphflow.msgs.registry import KINDS
from graphflow.reading import found_text
from graphflow.supervisor.launching.probe import probe
from graphflow.supervisor.launching.probed import read_interfaces, slips_in
from graphflow.workspace.node_classes import node_classes_in
from graphflow.workspace.project import add_interfaces, module_of, shown
from graphflow.workspace.source_kinds import uses_ros


def check_sources(paths: Sequence[Path], *, as_json: bool) -> int:
    """Report mistakes and deadlocks in the node classes of files, and of all files below folders.

    Classes written for graphflow are imported; those for rclpy are only read.

    Raises:
        UsageFault: A file does not exist, or none has a node.
    """
    found = _Findings()
    for path in paths:
        if not path.exists():
            raise UsageFault(f"there is no file {path}")
        if path.is_file() and path.suffix != ".py":
            raise UsageFault(f"{path} is not source: check it by itself, graphflow check {path}")
        for file in files_in(path):
            if (fault := _unreadable(file)) is not None:
                found.problems.append(fault)
            elif uses_ros(file):
                found.is_rclpy = True
                found.ways += findings_in(file)
                found.slips += rclpy_remarks(file)
                found.unfollowed += unfollowed_in(file)
            elif classes := node_classes_in(file):
                found.nodes += len(classes)
                wrong, ways, slips = _checked(file, classes)
                found.problems += wrong
                found.slips += slips
                found.ways += ways
    has_files = any(path.is_file() for path in paths)
    if not (found.nodes or found.is_rclpy or found.problems or has_files):
        way = _graphs_in(paths, "*.yaml", "graphs/*.yaml") or _interfaces_in(paths)
        raise UsageFault(f"{' '.join(map(str, paths))}: no nodes, of graphflow or of rclpy{way}")
    _report(paths, found, as_json=as_json)
    if found.problems:
        return exits.USAGE
    return exits.FAILED if any(way.grade == "CERTAIN" for way in found.ways) else exits.OK


_SHOWN = 5
"""Graph files that a hint names."""


@dataclass
class _Findings:
    """Findings in the source of nodes."""

    problems: list[Problem] = field(default_factory=list)
    ways: list[Finding] = field(default_factory=list)
    """Deadlocks."""
    slips: list[str] = field(default_factory=list)
    """Probable mistakes that Python does not report."""
    unfollowed: list[Place] = field(default_factory=list)
    """Loops in rclpy callbacks that poll a value whose assignment is not in their file."""
    nodes: int = 0
    """Number of classes written for graphflow."""
    is_rclpy: bool = False
    """Whether some source is written for rclpy."""


def _unreadable(file: Path) -> Problem | None:
    try:
        ast.parse(found_text(file))
    except SyntaxError as error:
        return Problem(
            Place(shown(file), error.lineno or 1, error.offset or 1),
            f"SyntaxError: {error.msg}{hyphen_hint(error.text or '')}",
        )
    except (OSError, ValueError) as error:
        return Problem(Place(shown(file)), f"cannot be read: {error}")
    return None


def rclpy_remarks(file: Path) -> list[str]:
    """Return the remarks on source that is written for rclpy, and is not run."""
    module = ast.parse(found_text(file))
    found = sorted({*rclpy_source.slips(module), *rclpy_source.foreseen(module), *named_only(module)})
    return [f"{Place(shown(file), line)}: {text}" for line, text in found]


def _checked(file: Path, classes: dict[str, int]) -> tuple[list[Problem], list[Finding], list[str]]:
    """Import the classes of a file; return their mistakes, the deadlocks of a graph of them, and slips."""
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
    # Calls of other nodes can only be resolved within a graph.
    ways = [way for way in deadlock_check.findings(plan, interfaces) if way.grade != "unresolved"]
    # A failing import is reported for each class of the module: keep one.
    problems = {problem.message: problem for found in reversed(alone) for problem in found}
    return list(problems.values()), ways, slips_in(data)


def _report(paths: Sequence[Path], found: _Findings, *, as_json: bool) -> None:
    if as_json:
        deadlocks = [{"grade": way.grade, "text": str(way), **place_of(way.place)} for way in found.ways]
        problems = [{"message": problem.message, **place_of(problem.place)} for problem in found.problems]
        unfollowed = [place_of(place) for place in found.unfollowed]
        output.as_json({"problems": problems, "remarks": found.slips, "deadlocks": deadlocks, "unfollowed": unfollowed})
        return
    for problem in found.problems:
        output.talk(str(problem))
    output.lines(found.slips)
    output.lines(f"{place}: not analysed: the source does not show what ends this loop" for place in found.unfollowed)
    output.lines(str(way) for way in found.ways)
    where = paths[0] if len(paths) == 1 else f"{len(paths)} paths"
    output.data(f"{where}: {', '.join(_counts(found))}{_graphs_in(paths, 'graphs/*.yaml')}")


def _counts(found: _Findings) -> Iterator[str]:
    if found.nodes:
        yield f"{found.nodes} node class{'es' * (found.nodes != 1)}"
    if found.problems:
        yield _count(found.problems, "problem")
    if found.ways:
        yield f"{_count(found.ways, 'deadlock')} in the source"
    if not found.problems and not found.ways:
        if not found.nodes:
            yield "no deadlocks visible in the source"
        elif not found.slips:
            yield "no problems"
    if found.slips:
        yield _count(found.slips, "remark")
    if found.unfollowed:
        yield f"{_count(found.unfollowed, 'loop')} not analysed"


def _count(things: Sequence[object], word: str) -> str:
    return f"{len(things)} {word}{'s' * (len(things) != 1)}"


def place_of(place: Place) -> dict[str, str | int]:
    """Convert a place to JSON."""
    return {"file": place.file, "line": place.line, "column": place.column}


def _graphs_in(paths: Sequence[Path], *patterns: str) -> str:
    """Return a hint to check the graph files of folders, too; empty if there are none.

    Args:
        patterns: Paths of graph files within a folder.
    """
    folders = [path for path in paths if path.is_dir()]
    near = sorted(str(file) for folder in folders for pattern in patterns for file in folder.glob(pattern))
    more = f" and {len(near) - _SHOWN} more" if len(near) > _SHOWN else ""
    return f"; check its graph files one by one: {', '.join(near[:_SHOWN])}{more}" if near else ""


def _interfaces_in(paths: Sequence[Path]) -> str:
    """Return a hint for folders with interface definitions; empty if there are none."""
    has_some = any((path / kind).is_dir() for path in paths for kind in KINDS)
    return "; graphflow ws checks its interfaces" if has_some else ""
