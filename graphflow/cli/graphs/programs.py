"""The source of the programs of a graph, for `graphflow check`, which reads those written for rclpy in Python."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from graphflow.graph.plan import Plan, PlannedNode
from graphflow.workspace.packages import find_workspace
from graphflow.workspace.source_kinds import uses_ros


def sources(plan: Plan) -> tuple[list[Path], list[PlannedNode]]:
    """Return the files of a graph's programs that can be checked, and the nodes whose programs cannot."""
    files: dict[Path, None] = {}
    unread = []
    for node in plan.nodes:
        file = _file(node.command, Path(plan.root)) if node.command else None
        if file is not None and file.is_file() and uses_ros(file):
            files[file] = None
        elif node.command:
            unread.append(node)
    return list(files), unread


def _file(command: Sequence[str], root: Path) -> Path | None:
    """Return the Python file that a command line runs; None if that is not known."""
    match command:
        case "graphflow", "run", script, *_ if script.endswith(".py"):
            return Path(script)
        case (("python" | "python3"), script, *_) if script.endswith(".py"):
            return root / script
        case "graphflow", "run", folder, name, *_:
            packages = find_workspace(root).packages.values()
            own = next((package for package in packages if str(package.folder) == folder), None)
            if own is not None and name in own.programs:
                return own.programs[name]
            return own.file_of(own.entry_points[name]) if own is not None and name in own.entry_points else None
    return None
