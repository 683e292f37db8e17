"""The recorder of Python launch files: a process that runs one against substitutes for ROS's launch packages.

    python -m graphflow.rclpy -m graphflow.supervisor.launching.launch_recorder FILE [VALUES]
        ->   {"actions": [...], "problems": [...], "remarks": [...]}

The recorded calls are converted to actions of the YAML launch dialect, each with its line. VALUES, the file's arguments
as JSON, are for a file that is to be started: then package folders and the values of arguments are real.
"""

from __future__ import annotations

import ast
import contextlib
import json
import logging
import os
import re
import runpy
import sys
from collections.abc import Mapping
from typing import Any

from graphflow.launchfiles.python.actions import actions, number_targets
from graphflow.launchfiles.python.early_uses import early_uses
from graphflow.launchfiles.python.names import BASES, NAMES
from graphflow.launchfiles.python.recording import RECORDING, as_text
from graphflow.launchfiles.python.stand_ins import RecordedCall, StandIns
from graphflow.launchfiles.python.unused import unused_actions
from graphflow.names import nearest
from graphflow.supervisor.launching.launch_service import Described
from graphflow.wire.profile import wire_profile

_FUNCTION = "generate_launch_description"
_IN_F_STRING = " in an f-string is an object to ROS 2"
_ADDING = ("add_action", "add_entity")
_HOMES = {name: f"from {module} import {name}" for module, names in NAMES.items() for name in names.split()} | {
    name: f"from ament_index_python.packages import {name}"
    for name in ("get_package_share_directory", "get_package_share_path", "get_package_prefix")
}
"""Import statements for the names that launch files use."""


class _Environment(dict[str, str]):
    """The environment of a file that is only converted: a missing variable is a substitution, which paths keep."""

    def __missing__(self, name: str) -> str:
        return f"$(env {name})"


def record(path: str, values: Mapping[str, Any] | None) -> dict[str, Any]:
    """Run a launch file; returns its actions, the problems of those that cannot be converted, and remarks.

    Args:
        values: The arguments that it is started with; None if it is only converted.
    """
    RECORDING.file = path
    if values is not None:
        RECORDING.values = {name: as_text(value) for name, value in values.items()}
        logging.basicConfig(level=logging.INFO, format="[%(levelname)s] [%(name)s]: %(message)s", stream=sys.stderr)
    sys.meta_path.insert(0, StandIns())
    sys.argv = ["ros2", "launch", path, *(f"{name}:={value}" for name, value in (RECORDING.values or {}).items())]
    os.environ.setdefault("ROS_DISTRO", wire_profile())  # as in a shell that sources ROS 2
    before = dict(os.environ)
    if values is None:
        os.environ = _Environment(os.environ)  # type: ignore[assignment]  # noqa: B003 - for Python alone, not for child processes
    found: list[dict[str, Any]] = []
    try:
        tree = _tree(path)
        whole = _described(path, tree)
        number_targets(whole)
        found = actions(whole)
        _report_unused(tree, found)
        _report_late(found)
        changed = {name: value for name, value in os.environ.items() if before.get(name) != value}
        if not found and not RECORDING.problems:
            RECORDING.remarks.append({"line": 1, "message": "the launch description has no actions"})
        found = [*({"set_env": {"name": n, "value": v, "line": 1}} for n, v in changed.items()), *found]
    except (Exception, SystemExit) as error:  # the user's file may raise anything
        trace, line = error.__traceback__, getattr(error, "lineno", None) or RECORDING.written_at
        known: set[str] = set()
        while trace is not None:
            if trace.tb_frame.f_code.co_filename == path:
                line, known = trace.tb_lineno, {*trace.tb_frame.f_locals, *trace.tb_frame.f_globals}
            trace = trace.tb_next
        hint = f"; if it is on PyPI: pip install {error.name}" if isinstance(error, ModuleNotFoundError) else ""
        hint = _instead(error.name, known) if isinstance(error, NameError) and error.name else hint
        no_path = re.search(r"os\.PathLike object, not '?(\w+)", str(error)) if isinstance(error, TypeError) else None
        if no_path is not None and BASES.get(no_path[1]) == "Substitution":
            hint = f"; write PathJoinSubstitution([..., {no_path[1]}(...)])"
        if isinstance(error, TypeError) and str(error).startswith("Node.__init__() got an unexpected keyword"):
            hint = "; this Node is rclpy's: write from launch_ros.actions import Node"
        hint = hint or _before_launch(error)
        RECORDING.problems.append({"line": line, "message": f"{type(error).__name__}: {error}{hint}"})
    _explain()
    return {"actions": found, "problems": RECORDING.problems, "remarks": RECORDING.remarks}


def _before_launch(error: BaseException) -> str:
    """Return advice on code that uses a substitution as if it were its value; empty for other errors."""
    if not isinstance(error, (TypeError, ValueError, AttributeError)) or "write" in str(error):
        return ""
    of_one = next((name for name in re.findall(r"\w+", str(error)) if BASES.get(name) == "Substitution"), "")
    if not of_one and "$(" in str(error):  # its text form, as in int(str(...))
        of_one = "a substitution"
    how = "write OpaqueFunction(function=setup), with def setup(context): and .perform(context) in it"
    return f"; {of_one} has no value before the launch: {how}" if of_one else ""


def _explain() -> None:
    """Merge each problem with the remark that gives its cause."""
    static = {remark["line"] for remark in RECORDING.remarks if _IN_F_STRING not in remark["message"]}
    RECORDING.remarks = [r for r in RECORDING.remarks if _IN_F_STRING not in r["message"] or r["line"] not in static]
    for problem in RECORDING.problems:
        for remark in [remark for remark in RECORDING.remarks if remark["line"] == problem["line"]]:
            if "takes texts, and not" in problem["message"]:
                RECORDING.remarks.remove(remark)
                problem["message"] = remark["message"]


def _report_unused(tree: ast.Module, found: list[dict[str, Any]]) -> None:
    """Remark on actions that are in no description; an argument that another action uses is a problem."""
    written = json.dumps(found)
    known = {*(RECORDING.values or {}), *RECORDING.set}
    for line, message, argument in unused_actions(tree):
        is_missed = argument and re.search(rf"\$\(var '?{re.escape(argument)}'?\)", written)
        is_set = argument in known or any(f'"{kind}": {{' in written for kind in ("let", "include"))
        if is_missed and not is_set:
            RECORDING.problems.append({"line": line, "message": message})
            found.insert(0, {"arg": {"name": argument, "default": "", "line": line}})  # so that it is reported once
        else:
            RECORDING.remarks.append({"line": line, "message": message})


def _report_late(found: list[dict[str, Any]]) -> None:
    """Remark on actions that use an argument declared only after them: ROS 2 executes a description in order."""
    earlier: list[tuple[int, str]] = []
    known = {*(RECORDING.values or {}), *RECORDING.set}
    for action in found:
        [(kind, given)] = action.items() if len(action) == 1 else [("", action)]
        line = given.get("line", 1) if isinstance(given, dict) else 1
        name = given["name"] if kind == "arg" else None
        if name is not None and name not in known:
            users = [user for user, text in earlier if re.search(rf"\$\(var '?{re.escape(str(name))}'?\)", text)]
            message = f"{name!r} is used here and declared only in line {line}, and ROS 2 then has no value for it; "
            message += "put its DeclareLaunchArgument before this"
            RECORDING.remarks += [{"line": user, "message": message} for user in users[:1]]
            known.add(name)
        earlier.append((line, json.dumps(given, default=str)))


def _instead(name: str, known: set[str]) -> str:
    """Return advice on an undefined name: the name that may be meant, and its import.

    Args:
        known: The names that are defined there.
    """
    if name in sys.stdlib_module_names and name not in known:
        return f"; write import {name}"
    near = name if name in _HOMES else nearest(name, [*known, *_HOMES], cutoff=0.8)
    if near is None:
        return ""
    write = "" if near in known else f"; write {_HOMES[near]}"
    return write if near == name else f"; did you mean {near!r}?{write.replace('; write', ' Write')}"


def _tree(path: str) -> ast.Module:
    with open(path, "rb") as file:  # as Python reads it: its encoding may be declared, or marked by a byte order mark
        return ast.parse(file.read(), path)


def _described(path: str, tree: ast.Module) -> list[Any]:
    """Return the description of a file: from its function, or from the `LaunchService` that it runs."""
    code = compile(tree, path, "exec")
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Attribute) and node.value.attr in _ADDING:
            text = f"{node.value.attr} is not called: put its argument in parentheses after it"
            RECORDING.problems.append({"line": node.lineno, "message": text})
    RECORDING.remarks += [{"line": line, "message": text} for line, text in early_uses(tree)]
    space: dict[str, Any] = {"__name__": "launch_file", "__file__": path}
    exec(code, space)  # noqa: S102 - the user's own file, in a process of its own
    if _FUNCTION not in space:
        if any(isinstance(n, ast.Name | ast.Attribute) and _last(n) == "LaunchService" for n in ast.walk(tree)):
            try:
                runpy.run_path(path, run_name="__main__")
            except Described as described:
                return described.description
        functions = {n.name: n.lineno for n in tree.body if isinstance(n, ast.FunctionDef)}
        near = nearest(_FUNCTION, functions, cutoff=0.75)
        where = f"; rename {near} in line {functions[near]}" if near else ""
        raise NameError(f"it has no function {_FUNCTION}(){where}")
    description = space[_FUNCTION]()
    if not isinstance(description, RecordedCall):
        own = [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == _FUNCTION]
        RECORDING.written_at = own[-1].body[-1].lineno if own else 1
        raise _no_description(description)
    return [description]


def _no_description(returned: object) -> TypeError:
    """Return the error for a function that returns anything else."""
    what, hint = repr(returned), ""
    if isinstance(returned, (list, tuple)):
        what, hint = "a list", "; write LaunchDescription(...) around it"
    elif returned is None:
        hint = "; a return is missing"
    return TypeError(f"{_FUNCTION}() returned {what}, and not a LaunchDescription{hint}")


def _last(expression: ast.Name | ast.Attribute) -> str:
    return expression.id if isinstance(expression, ast.Name) else expression.attr


def main() -> None:
    out = os.dup(1)
    os.dup2(2, 1)  # output of the file must not mix with the answer
    with contextlib.redirect_stdout(sys.stderr):
        found = record(os.path.abspath(sys.argv[1]), json.loads(sys.argv[2]) if len(sys.argv) > 2 else None)
    os.write(out, json.dumps(found).encode())


if __name__ == "__main__":
    main()
