"""Reading of graph files and launch files, in YAML, XML or Python, as trees in the form of a graph file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.launchfiles import conversion
from graphflow.launchfiles.attributes import unescaped
from graphflow.launchfiles.conversion import ignore
from graphflow.launchfiles.known_actions import KNOWN_ACTIONS
from graphflow.launchfiles.recorded import Describe
from graphflow.markup import source, xml_source
from graphflow.markup.source import Complain
from graphflow.markup.tree import Item, tree
from graphflow.workspace.project import project_root


def read(
    path: Path,
    name: str,
    complain: Complain,
    note: Complain = ignore,
    describe: Describe | None = None,
    values: Mapping[str, object] | None = None,
    remark: Complain = ignore,
    number: int = 1,
    leave_out: Complain = ignore,
) -> Item:
    """Read a graph file, or a launch file in YAML, XML or Python.

    Args:
        name: The file as messages show it.
        complain: Called with each part of a launch file that a graph file cannot express.
        note: Called with remarks on a converted launch file.
        describe: Runs a launch file in Python; such files are refused without.
        values: The arguments with which a launch file in Python is being started; None if it is only converted.
        remark: Called with each part of a launch file in Python that is left out, and with oddities of YAML.
        number: The position of the file among those of the graph, which makes names of steps unique.
        leave_out: Called with programs of a launch file that are not installed.

    Raises:
        GraphFileError: The file cannot be read; with the reason and the place.
    """
    if path.suffix == ".py":
        if describe is None:
            text = f"a launch file in Python is converted first: graphflow launch convert {name} -o {path.stem}.yaml"
            raise GraphFileError([Problem(Place(name), text)])
        description = describe(path, name, values)
        for problem in description["problems"]:
            complain(Place(name, problem["line"], 1), problem["message"])
        for omission in description["remarks"]:
            remark(Place(name, omission["line"], 1), omission["message"])
        recorded = conversion.recorded(description["actions"], name)
        return conversion.native(recorded, project_root(path), complain, note, number, leave_out)
    if path.suffix in (".xml", ".launch"):
        top = xml_source.read_file(path, name)
    else:
        top = tree(source.read_file(path, name, complain=complain, remark=remark))
    if conversion.is_launch_file(top):
        return conversion.native(unescaped(top), project_root(path), complain, note, number, leave_out)
    if "launch" in top.entries and top.entries["launch"].entries:
        raise _error(name, top.entries["launch"], "launch: expected a list of actions; write - before each")
    if isinstance(top.value, list) and any(action.entries.keys() & KNOWN_ACTIONS for action in top.items):
        raise _error(name, top, "a launch file begins with launch:, and its actions are listed below that")
    return top


def _error(name: str, item: Item, message: str) -> GraphFileError:
    return GraphFileError([Problem(item.place or Place(name), message)])
