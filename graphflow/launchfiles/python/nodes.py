"""Attributes of nodes, processes and parameters in the YAML launch dialect, from recorded calls."""

from __future__ import annotations

import os
import re
import shlex

import yaml

from graphflow.launchfiles.attributes import output_fault
from graphflow.launchfiles.python.events import is_shutdown, without_functions
from graphflow.launchfiles.python.names import NAMES
from graphflow.launchfiles.python.recording import RECORDING
from graphflow.launchfiles.python.stand_ins import RecordedCall, called_as, condition, plain, text
from graphflow.markup.source import Data, scalar

_OF_CONTAINERS = frozenset(
    ("respawn", "parameters", "remappings", "env", "additional_env", "on_exit", "ros_arguments", "arguments")
)
"""Arguments of containers that only their nodes have in a graph file."""
_SUBSTITUTIONS = frozenset(NAMES["launch.substitutions"].split())
_RULE = re.compile(r"((?!__)[\w/.~]+):=(.*)")
"""A parameter or remap of a command line."""
_JOINED = re.compile(r"-[pr] |--(param|remap|params-file|log-level) ")
"""A flag that has its value in the same word."""
_TYPED = {"ParameterValue": 0, "Parameter": 1}
"""Classes that give a parameter a type, with the positions of their values."""


def condition_of(call: RecordedCall) -> dict[str, str]:
    """Return the attribute `if` or `unless` of an action; empty for one without a condition."""
    given = call.get("condition")
    if given is None:
        return {}
    if not isinstance(given, RecordedCall) or given.kind in _SUBSTITUTIONS:
        RECORDING.problem(call, f"condition: write IfCondition({called_as(given)}) or UnlessCondition(...)")
        return {}
    return condition(given)


def common(call: RecordedCall) -> dict[str, Data]:
    """Return the attributes that nodes and other processes share."""
    found: dict[str, Data] = {}
    for key in ("name", "namespace", "cwd", "respawn", "respawn_delay", "respawn_max_retries", "shell"):
        if call.get(key) is not None:
            found[key] = text(call.get(key))
    output = call.get("output")
    fault = output_fault(text(output) if isinstance(output, RecordedCall) else output)
    if fault is not None:
        RECORDING.problem(call, f"{call.kind}: {fault}")
    if call.get("prefix") is not None:
        found["launch-prefix"] = text(call.get("prefix"))
    variables = {**(call.get("env") or {}), **(call.get("additional_env") or {})}
    if variables:
        found["env"] = [{"name": text(key), "value": text(value)} for key, value in variables.items()]
    if any(map(is_shutdown, without_functions(call.get("on_exit"))[0])):
        found["on_exit"] = "shutdown"
    return found


def process(call: RecordedCall) -> dict[str, Data]:
    """Return the attributes of a process that is no node."""
    cmd = call.get("cmd", 0, [])
    if isinstance(cmd, str):
        RECORDING.problem(call, f"cmd: expected a list of words, such as {words_of(cmd)!r}, got {cmd!r}")
        cmd = words_of(cmd)
    return {**common(call), "cmd": [text(word) for word in cmd]}


def words_of(command: str) -> list[str]:
    """Split a command line as a shell does, or at spaces if its quotes do not match."""
    try:
        return shlex.split(command)
    except ValueError:
        return command.split()


def node(call: RecordedCall) -> dict[str, Data]:
    """Return the attributes of a node."""
    found = common(call)
    for position, (key, ours) in enumerate((("package", "pkg"), ("executable", "exec"))):
        # An argument by position, or by its former name, is already reported.
        value = call.get(key, position, call.get(f"node_{key}", default=call.get(ours)))
        if value is not None:
            found[ours] = text(value)
    for key, ours in (("arguments", "args"), ("ros_arguments", "ros_args")):
        words = _list(call, key, "['--fast']")
        if words:
            found[ours] = [text(word) for word in words]
            _check_words(call, key, words)
    remaps = _remaps(call)
    if remaps:
        found["remap"] = remaps
    params = _params(call)
    if params:
        found["param"] = params
    return found


def _check_words(call: RecordedCall, key: str, words: list[object]) -> None:
    """Remark on ROS arguments in the wrong place, or two in one word."""
    if key == "ros_arguments":
        for word in words:
            if isinstance(word, str) and (found := _JOINED.match(word)):
                flag, rest = found[0].strip(), word[found.end() :]
                RECORDING.remark(call, f"ros_arguments: {word!r} is one word; write {flag!r}, {rest!r}")
        return
    if "--ros-args" in words or text(call.get("executable")) == "xacro":  # xacro reads name:=value
        return
    for word in words:
        if isinstance(word, str) and (rule := _RULE.fullmatch(word)):
            name, value = rule.groups()
            way = f"parameters=[{{{name!r}: {value or '...'}}}], or remappings=[({name!r}, {value!r})]"
            RECORDING.remark(call, f"arguments: nothing reads {word!r}; write {way}")


def _remaps(call: RecordedCall) -> list[Data]:
    pairs = _list(call, "remappings", "[('from', 'to')]")
    found: list[Data] = []
    for pair in pairs:
        if not isinstance(pair, (list, tuple)) or len(pair) != 2:
            RECORDING.problem(call, f"remappings: expected pairs, such as [('from', 'to')], got {pairs!r}")
            return []
        found.append({"from": text(pair[0]), "to": text(pair[1])})
    return found


def _params(call: RecordedCall) -> list[Data]:
    params: list[Data] = []
    for given in _list(call, "parameters", "[{'rate': 2.0}]"):
        if isinstance(given, dict):
            for key, value in given.items():
                if not _is_value(value):
                    fault = f"parameters: {text(key)!r} has {called_as(value)}: it takes a number, text, truth or list"
                    RECORDING.problem(call, f"{fault} of one of these")
                params.append(parameter(key, value))
        elif isinstance(given, RecordedCall) and given.kind == "Parameter":
            params.append(parameter(given.get("name", 0), given))
        elif isinstance(given, (set, int, float)):
            hint = "; write {'name': value}, with a colon" if isinstance(given, set) else "; write [{'name': value}]"
            RECORDING.problem(call, f"parameters: {given!r} is neither a dictionary nor a file{hint}")
        else:
            params.append({"from": text(given), **_allow_substs(given)})
    return params


def _list(call: RecordedCall, key: str, example: str) -> list[object]:
    """Return a list argument of a node; anything else is reported as a problem."""
    given = call.get(key)
    if given is None or isinstance(given, (list, tuple)):
        return list(given or ())
    RECORDING.problem(call, f"{key}: expected a list, such as {example}, got {given!r}")
    return []


def _allow_substs(file: object) -> dict[str, Data]:
    """Return the attribute that has substitutions made in a parameter file, if it is set."""
    if not isinstance(file, RecordedCall) or file.kind != "ParameterFile":
        return {}
    allowed = file.get("allow_substs", default=False)
    return {"allow_substs": RECORDING.known(text(allowed))} if allowed else {}


def container(call: RecordedCall) -> dict[str, Data]:
    """Return the attributes of a component container."""
    for key in sorted(_OF_CONTAINERS & {key for key, value in call.kwargs.items() if value}):
        why = "a container is a process that nodes share; write it at the nodes"
        RECORDING.remark(call, f"{key}: left out, since {why}")
    return {"name": text(call.get("name")), "composable_node": components(call)}


def components(call: RecordedCall) -> list[Data]:
    """Return the attributes of the nodes in a container, one mapping for each."""
    found: list[Data] = []
    for one in call.get("composable_node_descriptions") or []:
        if isinstance(one, RecordedCall):
            attributes = {key: value for key, value in node(one).items() if key != "exec"}
            found.append({**attributes, "plugin": text(one.get("plugin")), **condition_of(one)})
    return found


def _is_value(value: object) -> bool:
    """Whether ROS takes a value for a parameter: no list in a list, unless that consists of substitutions and texts."""
    if isinstance(value, dict):
        return all(map(_is_value, value.values()))
    parts = value if isinstance(value, (list, tuple)) else [value]
    inner = [one for part in parts for one in (part if isinstance(part, (list, tuple)) else ())]
    plains = [part for part in parts if not isinstance(part, (list, tuple))]
    return all(isinstance(one, (bool, int, float, str, RecordedCall, os.PathLike)) for one in plains) and all(
        isinstance(one, (str, RecordedCall)) for one in inner
    )


def parameter(name: object, value: object) -> dict[str, Data]:
    """Return the attributes of a parameter: name, value, and a type if the value does not imply it."""
    if isinstance(value, dict):
        return {"name": text(name), "param": [parameter(key, inner) for key, inner in value.items()]}
    if isinstance(value, RecordedCall) and value.kind in _TYPED:
        kind, inner = _type_name(value.get("value_type")), value.get("value", _TYPED[value.kind])
        return parameter(name, inner) | ({"type": kind} if kind else {})
    found: dict[str, Data] = {"name": text(name), "value": plain(value)}
    if isinstance(value, str) and "$(" not in value and _is_number_to_ros(value):
        found["value"] = scalar(value)
    is_made = isinstance(value, RecordedCall) or (
        isinstance(value, (list, tuple)) and not all(isinstance(one, (bool, int, float, str)) for one in value)
    )
    if is_made and "$(" not in str(found["value"]):  # ROS parses the result of substitutions as YAML
        found["type"] = "yaml"
    return found


def _type_name(given: object) -> str:
    """Return the launch dialect's name of a Python type: `list_of_int` for `List[int]`."""
    # `typing.List[int]` is no type, and shares no base class with `list[int]`.
    inner = getattr(given, "__args__", ())
    return f"list_of_{inner[0].__name__}" if inner else getattr(given, "__name__", "")


def _is_number_to_ros(value: str) -> bool:
    """Return whether ROS writes a text without quotes and reads it back as a number.

    ROS writes files with PyYAML, which takes 1e-3 for text, and reads them with libyaml's number rules.
    """
    return isinstance(scalar(value), float) and isinstance(yaml.safe_load(value), str)
