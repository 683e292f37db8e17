"""`graphflow check` of ROS's own files: a file of parameters, and a package's `setup.py`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import yaml

from graphflow.cli import exits, output
from graphflow.cli.graphs.sources import place_of
from graphflow.errors import GraphFileError, Place, Problem, UsageFault
from graphflow.graph import params_file
from graphflow.graph.model import GraphFile, keys_of
from graphflow.names import nearest
from graphflow.reading import lenient_text
from graphflow.workspace.manifest import name_fault
from graphflow.workspace.packages import find_workspace
from graphflow.workspace.project import shown

_SECTION = re.compile(r"""^\s+["']?ros_+param(?:eter)?s?["']?\s*:""", re.MULTILINE)
_OTHER = re.compile(r"^(?:nodes|include|group|steps|templates|launch)\s*:", re.MULTILINE)
"""Keys at the top of a graph file, or of a launch file."""
_SLIP = 0.8
"""Similarity, from 0 to 1, from which a key counts as a misspelt one of a graph file."""
_SHOWN = 5
"""Names that one line shows."""


def is_parameters(file: Path) -> bool:
    """Return whether a YAML file has parameters by node, perhaps misspelt, and is no graph file."""
    text = lenient_text(file) if file.suffix in (".yaml", ".yml") else ""
    return _OTHER.search(text) is None and (_SECTION.search(text) is not None or _is_flat(text))


def _is_flat(text: str) -> bool:
    """Return whether a text is a mapping of plain values by name, or by node, with no key of a graph file."""
    try:
        data = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError):
        return False
    if not isinstance(data, dict) or any(nearest(str(key), keys_of(GraphFile), cutoff=_SLIP) for key in data):
        return False
    inner = [value for one in data.values() for value in (one.values() if isinstance(one, dict) else [one])]
    return bool(inner) and not any(isinstance(value, dict) for value in inner)


def check_parameters(file: Path, *, as_json: bool) -> int:
    """Report the mistakes in a file of parameters."""
    try:
        sections = params_file.read(file, shown(file))
    except GraphFileError as error:
        return _report(file, sorted(error.problems), "", as_json=as_json)
    names = [section.pattern for section in sections]
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return _report(file, [], f"parameters of {', '.join(names[:_SHOWN])}{more}", as_json=as_json)


def check_setup(file: Path, *, as_json: bool) -> int:
    """Report the executables of a `setup.py` that do not start.

    Raises:
        UsageFault: It is not that of a package.
    """
    folder, workspace = file.resolve().parent, find_workspace(file)
    known = (*workspace.packages.values(), *workspace.doubles)
    package = next((p for p in known if p.folder.resolve() == folder), None)
    if package is None:
        raise UsageFault(f"{file} is not that of a ROS package: there is no package.xml beside it")
    faults = [fault for name in package.executables if (fault := package.fault_of(name) or package.copy_fault(name))]
    faults += filter(None, [name_fault(package.folder, package.name)])
    problems = [_problem(fault) for fault in faults]
    if why := package.why_no_executable:
        problems.append(Problem(Place(str(file)), why.removeprefix("; ").removeprefix(f"{package.setup.file} ")))
    names = ", ".join(package.executables) or "none"
    return _report(file, problems, f"executables: {names}", as_json=as_json)


def _problem(fault: str) -> Problem:
    """Convert the fault of an executable, which begins with its place."""
    place, _, text = fault.partition(": ")
    name, _, line = place.rpartition(":")
    return Problem(Place(name, int(line)) if line.isdecimal() else Place(place), text)


def _report(file: Path, problems: Sequence[Problem], found: str, *, as_json: bool) -> int:
    if as_json:
        rows = [{"message": problem.message, **place_of(problem.place)} for problem in problems]
        output.as_json({"problems": rows, "remarks": [], "deadlocks": []})
    else:
        for problem in problems:
            output.talk(str(problem))
        count = f"{len(problems)} problem{'s' * (len(problems) != 1)}" if problems else "no problems"
        output.data(f"{file}: {', '.join(filter(None, [found, count]))}")
    return exits.USAGE if problems else exits.OK
