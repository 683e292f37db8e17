"""Files as trees of items, in our own words whatever they were written in: graph files, and ROS's launch files."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.launchfiles import conversion
from graphflow.launchfiles.attributes import unescaped
from graphflow.launchfiles.commands import Complain
from graphflow.launchfiles.conversion import ignore
from graphflow.markup import source, xml_source
from graphflow.markup.tree import Item, tree
from graphflow.workspace.project import project_root

Describe = Callable[[Path, str, Mapping[str, Any] | None], dict[str, Any]]
"""Runs a launch file in Python and returns what it describes: the file, as messages show it, and its arguments."""


def read(
    path: Path,
    name: str,
    complain: Complain,
    note: Complain = ignore,
    describe: Describe | None = None,
    values: Mapping[str, Any] | None = None,
    remark: Complain = ignore,
    number: int = 1,
    leave_out: Complain = ignore,
) -> Item:
    """A graph file, or a launch file in YAML, XML or Python.

    Args:
        name: The file as messages show it.
        complain: Called with what a launch file says that a graph file cannot.
        note: Called with what the reader of a converted launch file should know of.
        describe: For those in Python.
        values: The arguments that such a file is about to be started with; None if it is only to be written down.
        remark: Called with what such a file says that is left out.
        number: Which file of the graph it is: steps that a launch file does not name are called by it.
        leave_out: Called with what such a file starts and nobody here has.

    Raises:
        GraphFileError: It cannot be read; why, and where.
    """
    if path.suffix == ".py":
        if describe is None:
            text = f"a launch file in Python is converted first: graphflow launch convert {name} -o {path.stem}.yaml"
            raise GraphFileError([Problem(Place(name), text)])
        told = describe(path, name, values)
        for problem in told["problems"]:
            complain(Place(name, problem["line"], 1), problem["message"])
        for left_out in told["remarks"]:
            remark(Place(name, left_out["line"], 1), left_out["message"])
        recorded = conversion.recorded(told["actions"], name)
        return conversion.native(recorded, project_root(path), complain, note, number, leave_out)
    if path.suffix in (".xml", ".launch"):
        top = xml_source.read_file(path, name)
    else:
        top = tree(source.read_file(path, name, complain=complain))
    if conversion.is_launch_file(top):
        return conversion.native(unescaped(top), project_root(path), complain, note, number, leave_out)
    if "launch" in top.entries and top.entries["launch"].entries:
        raise _error(name, top.entries["launch"], "launch: expected a list of actions; write - before each")
    if isinstance(top.value, list) and any(action.entries.keys() & conversion.KNOWN_ACTIONS for action in top.value):
        raise _error(name, top, "a launch file begins with launch:, and its actions are listed below that")
    return top


def _error(name: str, item: Item, message: str) -> GraphFileError:
    return GraphFileError([Problem(item.place or Place(name), message)])
