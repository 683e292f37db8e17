"""What stand-ins for ROS's launch packages were called with, as actions of ROS's YAML dialect, each with its line."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import yaml

from graphflow.launchfiles.attributes import output_fault
from graphflow.launchfiles.python.calls import code_of, is_off
from graphflow.launchfiles.python.names import NAMES
from graphflow.launchfiles.python.stand_ins import RECORDING, Context, Said, condition, no_words, plain, text
from graphflow.markup.source import scalar

_described: dict[int, Said] = {}
"""Actions that have been written down, which are kept, so that no other has their number."""
_numbers: dict[int, int] = {}
"""Numbers of actions that others come after."""
_ending: set[int] = set()
"""Actions with whose end everything ends."""
_lives: dict[int, str] = {}
"""The states that lifecycle nodes are brought to."""
_SUBSTITUTIONS = frozenset(NAMES["launch.substitutions"].split())
_STATES = {"configure": "inactive", "activate": "active"}
"""Where transitions of lifecycle nodes lead."""
_TRANSITIONS = {1: "configure", 2: "cleanup", 3: "activate", 4: "deactivate", **dict.fromkeys((5, 6, 7), "shutdown")}
"""Those of lifecycle_msgs/msg/Transition."""


def actions(said: Any) -> list[dict[str, Any]]:
    """What was described, as actions of the YAML dialect."""
    if isinstance(said, (list, tuple)):
        found, later = [], []
        for one in said:
            if _is_early(one):
                later.append(one)
            else:
                found += actions(one)
        return found + [action for one in later for action in actions(one)]
    if said is None:
        return []
    if not isinstance(said, Said):
        shown = f"the class {said.__name__}" if isinstance(said, type) else repr(said)
        RECORDING.problems.append({"line": RECORDING.written_at, "message": f"{shown} is no action, such as Node(...)"})
        return []
    _described[id(said)] = said
    RECORDING.written_at = said.line
    name, attributes = _action(said)
    if name == "":
        return list(attributes)
    attributes |= {
        "line": said.line,
        **_condition(said),
    }
    if id(said) in _numbers:
        attributes["number"] = _numbers[id(said)]
    if id(said) in _ending:
        attributes["on_exit"] = "shutdown"
    if id(said) in _lives:
        attributes["brought_to"] = _lives[id(said)]
    return [{name: attributes}, *_after_exit(said)]


def _condition(said: Said) -> dict[str, str]:
    given = said.get("condition")
    if given is None:
        return {}
    if not isinstance(given, Said) or given.kind in _SUBSTITUTIONS:
        RECORDING.problem(said, f"condition: write IfCondition({_called_as(given)}) or UnlessCondition(...)")
        return {}
    return condition(given)


def _called_as(given: Any) -> str:
    """A value as a launch file has it."""
    return f"{given.kind}(...)" if isinstance(given, Said) else repr(given)


def _action(said: Said) -> tuple[str, Any]:
    get = said.get
    _keep(said)
    if (code := code_of(said)) is not None:
        return "", [] if is_off(said) else _called(said, code)
    match said.kind:
        case "LaunchDescription":
            return "", actions(said.entities)
        case "ReplaceEnvironmentVariables":
            return "", []
        case "DeclareLaunchArgument":
            found: dict[str, Any] = {"name": text(get("name", 0)), "description": text(get("description", default=""))}
            if get("default_value") is not None:
                found["default"] = text(get("default_value"))
            if get("choices"):
                found["choice"] = [{"value": text(choice)} for choice in get("choices")]
            return "arg", found
        case "SetLaunchConfiguration":
            return "let", {"name": text(get("name", 0)), "value": text(get("value", 1))}
        case "SetEnvironmentVariable":
            return "set_env", {"name": text(get("name", 0)), "value": text(get("value", 1))}
        case "AppendEnvironmentVariable":
            found = {"name": text(get("name", 0)), "value": text(get("value", 1))}
            separator = {} if get("separator", 3) is None else {"separator": text(get("separator", 3))}
            return "append_env", {**found, "prepend": str(get("prepend", 2, default=False)), **separator}
        case "SetParameter":
            found = _parameter(get("name", 0), get("value", 1))
            is_text = isinstance(found["value"], str) and "$(" not in found["value"]  # which is no text to be read
            return "set_parameter", {"type": "str", **found} if is_text else found
        case "SetRemap":
            return "set_remap", {"from": text(get("src", 0)), "to": text(get("dst", 1))}
        case "SetUseSimTime":
            return "set_use_sim_time", {"value": plain(get("value", 0))}
        case "PushRosNamespace" | "PushROSNamespace":
            return "push_ros_namespace", {"namespace": text(get("namespace", 0))}
        case "GroupAction":
            is_scoped, outer = bool(get("scoped", default=True)), (dict(RECORDING.set), dict(RECORDING.env))
            children = actions(_actions_of(said, 0))
            if is_scoped:
                RECORDING.set, RECORDING.env = outer
            return "group", {"children": children, "scoped": is_scoped}
        case "TimerAction":
            return "timer", {"period": _period(said), "children": actions(_actions_of(said))}
        case "IncludeLaunchDescription":
            arguments = dict(get("launch_arguments", default=None) or {})
            pairs = [{"name": text(key), "value": text(value)} for key, value in arguments.items()]
            return "include", {"file": text(get("launch_description_source", 0)), "arg": pairs}
        case "LogInfo" | "Log":
            return "log", {"message": text(get("msg", default=""))}
        case "UnregisterEventHandler":
            return "", []
        case "RegisterEventHandler":
            return "", [] if is_off(said) else _handled(said)
        case "EmitEvent" if (change := _change(said)) is not None:
            node, transition = change
            if transition in _STATES:  # the node has been told to be brought there
                return "", []
            parts = text([node.get("namespace", default=""), "/", node.get("name", default="")]).split("/")
            name = "/".join(["", *filter(None, parts)])
            return "executable", {**_common(said), "cmd": ["ros2", "lifecycle", "set", name, transition]}
        case "Shutdown" | "EmitEvent" if _is_shutdown(said):
            event = said if said.kind == "Shutdown" else get("event", 0)
            reason = text(event.get("reason", 0, default="")) or "a launch file asks for it"
            return "shutdown", {"reason": reason}
        case "Node" | "LifecycleNode":
            found = {"autostart": "true"} if get("autostart") is True else {}
            return "node", {**_node(said), **found}
        case "ComposableNodeContainer":
            for key in sorted(_OF_PROCESSES & {key for key, value in said.kwargs.items() if value}):
                why = "a container is a process that nodes share; write it at the nodes"
                RECORDING.remark(said, f"{key}: left out, since {why}")
            return "node_container", {"name": text(get("name")), "composable_node": _components(said)}
        case "LoadComposableNodes":
            target = get("target_container")
            is_action = isinstance(target, Said) and target.kind == "ComposableNodeContainer"
            name = text(target.get("name") if is_action else target)
            return "load_composable_node", {"target": name, "composable_node": _components(said)}
        case "ExecuteProcess" | "ExecuteLocal":
            first, *rest = get("cmd", 0, [""])
            if isinstance(first, Said) and first.kind == "ExecutableInPackage":  # a node, by another way
                found = {"pkg": text(first.get("package", 1)), "exec": text(first.get("executable", 0))}
                return "node", {**_common(said), **found, "args": [text(word) for word in rest]}
            return "executable", _process(said)
    RECORDING.problem(said, no_words(said))
    return "", []


_SETTING = ("SetLaunchConfiguration", "SetEnvironmentVariable", "AppendEnvironmentVariable")


def _keep(said: Said) -> None:
    """Note what an action sets, for functions that come after it and ask."""
    given = said.kwargs.get("condition")
    if said.kind not in _SETTING or RECORDING.values is None or (given is not None and not given.evaluate()):
        return
    name, value = (RECORDING.known(text(said.get(key, place))) for key, place in (("name", 0), ("value", 1)))
    if said.kind == "SetLaunchConfiguration":
        RECORDING.set[name] = value
        return
    former = Context().environment.get(name)
    if said.kind == "AppendEnvironmentVariable" and former is not None:
        parts = [former, value]
        is_first = bool(said.get("prepend", 2, default=False))
        value = text(said.get("separator", 3, os.pathsep)).join(parts[::-1] if is_first else parts)
    RECORDING.env[name] = value


_carried_out: list[dict[str, Any]] = []
"""Actions that the code which is being called has carried out itself so far."""


def _carry_out(said: Said) -> None:
    """Write down an action where the code of a launch file calls its `execute` or `visit`."""
    number_targets(said)
    _carried_out.extend(actions(said))


RECORDING.carry_out = _carry_out


def _called(said: Said, code: Callable[[], list[Any]]) -> list[dict[str, Any]]:
    """The actions that code makes: those it sets, carries out itself and returns."""
    if RECORDING.values is None and said.kind in ("ForEach", "ForLoop"):  # over what is not known yet
        RECORDING.problem(
            said, f"{said.kind} has no words in a graph file; `graphflow launch` starts the file as it is"
        )
        return []
    if RECORDING.values is None:
        text = f"{said.kind}: it was called once, with $(var ...) in place of each value; look what it made"
        RECORDING.problem(said, text)
    outer, before = _carried_out[:], dict(RECORDING.set)
    _carried_out.clear()
    found = code()
    number_targets(found)
    number_targets(RECORDING.descriptions)  # to which it may have added
    changed = {name: value for name, value in RECORDING.set.items() if before.get(name) != value}
    settings = [{"let": {"name": name, "value": value, "line": said.line}} for name, value in changed.items()]
    inner, _carried_out[:] = _carried_out[:], outer
    return [*settings, *inner, *actions(found)]


_HANDLERS = {
    "OnProcessExit": ("target_action", "on_exit", "exited"),
    "OnExecutionComplete": ("target_action", "on_completion", "exited"),
    "OnProcessStart": ("target_action", "on_start", "ready"),
    "OnStateTransition": ("target_lifecycle_node", "entities", "ready"),
}
"""Event handlers with words here: the arguments with whose event and with what follows, and what must have become."""


_LEFT_OUT = {
    "OnProcessIO": "OnProcessIO is left out: what a process prints is in its log, and the function is not called",
    "OnShutdown": "OnShutdown is left out: nothing is done when the graph stops",
}
"""Event handlers that are left out, and what is said of them."""


def _change(said: Any) -> tuple[Said, str] | None:
    """The lifecycle node that an event is for, and the transition."""
    event = said.get("event", 0) if isinstance(said, Said) and said.kind == "EmitEvent" else None
    if not isinstance(event, Said) or event.kind != "ChangeState":
        return None
    matcher, transition = event.get("lifecycle_node_matcher"), _TRANSITIONS.get(event.get("transition_id"))
    node = matcher.get("action", 0) if isinstance(matcher, Said) and matcher.kind == "matches_action" else None
    return (node, transition) if isinstance(node, Said) and transition else None


def _handled(said: Said) -> list[dict[str, Any]]:
    """Actions that begin when a process has started or ended, or a lifecycle node has come to a state."""
    handler = said.get("event_handler", 0)
    if isinstance(handler, Said) and handler.kind in _LEFT_OUT:
        RECORDING.remark(said, _LEFT_OUT[handler.kind])
        return []
    if not isinstance(handler, Said) or handler.kind not in _HANDLERS:
        RECORDING.problem(said, f"an event handler {getattr(handler, 'name', '')} has no words in a graph file")
        return []
    whose, key, what = _HANDLERS[handler.kind]
    target, then = handler.get(whose), handler.get(key)
    if callable(target) and not isinstance(target, Said):
        RECORDING.problem(said, f"{handler.kind}: only for one process, and not for those that a function chooses")
        return []
    then, functions = _without_functions(then)
    if functions or not isinstance(target, Said):
        whose = "a function" if functions else "what it does for every process"
        RECORDING.remark(said, f"{handler.kind}: {whose} is left out: nothing is called while the graph runs")
    if not isinstance(target, Said):
        return []
    goal = handler.get("goal_state")
    if goal is not None and goal not in (_lives.get(id(target)), "inactive" if id(target) in _lives else None):
        text = (
            f"OnStateTransition: nothing in this file brings the node to {goal!r} by EmitEvent(event=ChangeState(...))"
        )
        RECORDING.problem(said, text)
        return []
    return _after(target, [] if id(target) in _ending and all(map(_is_shutdown, then)) else then, what)


def _after(target: Said, then: list[Any], what: str) -> list[dict[str, Any]]:
    """Actions that come after another."""
    number = _numbers.setdefault(id(target), len(_numbers) + 1)
    found = actions(then)
    for action in found:
        for attributes in action.values():
            attributes["after_number"], attributes["after_what"] = number, what
    return found


def _after_exit(said: Said) -> list[dict[str, Any]]:
    """What is to be done when a process has ended, as it says itself."""
    then, functions = _without_functions(said.get("on_exit") if said.kind in _PROCESSES else None)
    if functions:
        RECORDING.remark(said, "on_exit: a function is left out: nothing is called while the graph runs")
    then = [one for one in then if not _is_shutdown(one)]
    return _after(said, then, "exited") if then else []


_PROCESSES = ("Node", "LifecycleNode", "ExecuteProcess", "ExecuteLocal")


def _without_functions(then: Any) -> tuple[list[Any], int]:
    """What follows an event, and how many functions in it would be called then."""
    whole = list(then) if isinstance(then, (list, tuple)) else [] if then is None else [then]
    kept = [one for one in whole if isinstance(one, Said) and code_of(one) is None]
    return kept, len(whole) - len(kept)


def _common(said: Said) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key in ("name", "namespace", "cwd", "respawn", "respawn_delay", "respawn_max_retries", "shell"):
        if said.get(key) is not None:
            found[key] = text(said.get(key))
    output = said.get("output")
    fault = output_fault(text(output) if isinstance(output, Said) else output)
    if fault is not None:
        RECORDING.problem(said, f"{said.kind}: {fault}")
    if said.get("prefix") is not None:
        found["launch-prefix"] = text(said.get("prefix"))
    variables = {**(said.get("env") or {}), **(said.get("additional_env") or {})}
    if variables:
        found["env"] = [{"name": text(key), "value": text(value)} for key, value in variables.items()]
    if any(map(_is_shutdown, _without_functions(said.get("on_exit"))[0])):
        found["on_exit"] = "shutdown"
    return found


def _process(said: Said) -> dict[str, Any]:
    cmd = said.get("cmd", 0, [])
    if isinstance(cmd, str):
        RECORDING.problem(said, f"cmd: expected a list of words, such as {cmd.split()!r}, got {cmd!r}")
        cmd = cmd.split()
    return {**_common(said), "cmd": [text(word) for word in cmd]}


def _actions_of(said: Said, place: int = -1) -> Any:
    given = said.get("actions", place, [])
    if not isinstance(given, Said):
        return given
    RECORDING.problem(said, f"{said.kind}: actions is a list: write [ ] around {_called_as(given)}")
    return []


def _period(said: Said) -> Any:
    """The seconds of a timer, which may be a substitution; anything else is a problem."""
    given = said.get("period")
    value = plain(given)
    if isinstance(value, str) and ("$(" in value or isinstance(scalar(value), (int, float))):
        return value
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return value
    if given is None and said.args:  # which is told already
        return 1.0
    RECORDING.problem(said, f"{said.kind}: period is a number of seconds, such as 2.0, and not {given!r}")
    return 1.0


def _list(said: Said, key: str, example: str) -> list[Any]:
    """A list that a node is given; anything else is a problem."""
    given = said.get(key)
    if given is None or isinstance(given, (list, tuple)):
        return list(given or ())
    RECORDING.problem(said, f"{key}: expected a list, such as {example}, got {given!r}")
    return []


def _node(said: Said) -> dict[str, Any]:
    found = _common(said)
    for place, (key, ours) in enumerate((("package", "pkg"), ("executable", "exec"))):
        given = said.get(key, place, said.get(f"node_{key}"))  # without a name, or by its former one, is told already
        if given is not None:
            found[ours] = text(given)
    for key, ours in (("arguments", "args"), ("ros_arguments", "ros_args")):
        words = _list(said, key, "['--fast']")
        if words:
            found[ours] = [text(word) for word in words]
    pairs = _list(said, "remappings", "[('from', 'to')]")
    if any(not isinstance(pair, (list, tuple)) or len(pair) != 2 for pair in pairs):
        RECORDING.problem(said, f"remappings: expected pairs, such as [('from', 'to')], got {pairs!r}")
    elif pairs:
        found["remap"] = [{"from": text(old), "to": text(new)} for old, new in pairs]
    params: list[dict[str, Any]] = []
    for given in _list(said, "parameters", "[{'rate': 2.0}]"):
        if isinstance(given, dict):
            params += [_parameter(key, value) for key, value in given.items()]
        elif isinstance(given, Said) and given.kind == "Parameter":
            params.append(_parameter(given.get("name", 0), given))
        elif isinstance(given, (set, int, float)):
            meant = "; write {'name': value}, with a colon" if isinstance(given, set) else ""
            RECORDING.problem(said, f"parameters: {given!r} is neither a dictionary nor a file{meant}")
        else:
            params.append({"from": text(given), **_substituted(given)})
    if params:
        found["param"] = params
    return found


def _substituted(given: Any) -> dict[str, str]:
    """Whether substitutions are made in a file of parameters."""
    is_asked = isinstance(given, Said) and given.kind == "ParameterFile" and given.get("allow_substs", default=False)
    return {"allow_substs": RECORDING.known(text(is_asked))} if is_asked else {}


_OF_PROCESSES = {
    "respawn",
    "parameters",
    "remappings",
    "env",
    "additional_env",
    "on_exit",
    "ros_arguments",
    "arguments",
}
"""Attributes of containers that count only at their nodes here."""


def _components(said: Said) -> list[dict[str, Any]]:
    described = said.get("composable_node_descriptions") or []
    nodes = [one for one in described if isinstance(one, Said)]
    return [
        {**{k: v for k, v in _node(one).items() if k != "exec"}, "plugin": text(one.get("plugin")), **_condition(one)}
        for one in nodes
    ]


def _parameter(name: Any, value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        return {"name": text(name), "param": [_parameter(key, inner) for key, inner in value.items()]}
    found = {"name": text(name), "value": plain(value)}
    if isinstance(value, Said) and value.kind in _TYPED:
        kind, inner = _type_name(value.get("value_type")), value.get("value", _TYPED[value.kind])
        return _parameter(name, inner) | ({"type": kind} if kind else {})
    if isinstance(value, str) and "$(" not in value and _is_number_to_ros(value):
        found["value"] = scalar(value)
    is_made = isinstance(value, Said) or (isinstance(value, (list, tuple)) and not all(map(_is_plain, value)))
    if is_made and "$(" not in str(found["value"]):  # ROS reads what substitutions have made
        found["type"] = "yaml"
    return found


def _is_plain(value: Any) -> bool:
    return isinstance(value, (bool, int, float, str))


_TYPED = {"ParameterValue": 0, "Parameter": 1}
"""Descriptions of parameters that may have a type, and where their values stand."""


def _type_name(given: Any) -> str:
    """A Python type by the name that it has in launch files: `list_of_int` for `List[int]`."""
    inner = getattr(given, "__args__", ())
    return f"list_of_{inner[0].__name__}" if inner else getattr(given, "__name__", "")


def _is_number_to_ros(value: str) -> bool:
    """Whether ROS writes a text without quotes, and reads it back as a number: PyYAML takes 1e-3 for a text."""
    return isinstance(scalar(value), float) and isinstance(yaml.safe_load(value), str)


def _is_early(said: Any) -> bool:
    """Whether an event handler stands before what it waits for."""
    handler = said.get("event_handler", 0) if isinstance(said, Said) and said.kind == "RegisterEventHandler" else None
    if not isinstance(handler, Said) or handler.kind not in _HANDLERS:
        return False
    return id(handler.get(_HANDLERS[handler.kind][0])) not in _described


def _is_shutdown(said: Any) -> bool:
    event = said.get("event", 0) if isinstance(said, Said) and said.kind == "EmitEvent" else said
    return isinstance(event, Said) and event.kind == "Shutdown"


def number_targets(said: Any) -> None:
    """Number the actions that event handlers wait for, and note what events bring about, before all is written down."""
    todo, known = [said], set[int]()
    while todo:
        one = todo.pop()
        if isinstance(one, (list, tuple)):
            todo += reversed(one)
        elif isinstance(one, Said) and id(one) not in known:  # a description may hold itself
            known.add(id(one))
            _number(one)
            todo += reversed([*one.args, *one.kwargs.values(), *one.__dict__.get("entities", ())])


def _number(said: Said) -> None:
    if said.kind in _PROCESSES and said.get("on_exit") is not None:
        _numbers.setdefault(id(said), len(_numbers) + 1)
    whose, key, _ = _HANDLERS.get(said.kind, ("", "", ""))
    if isinstance(target := said.get(whose), Said):
        _numbers.setdefault(id(target), len(_numbers) + 1)
        then = said.get(key) if key in ("on_exit", "on_completion") else None
        kept = _without_functions(then)[0]
        if kept and all(map(_is_shutdown, kept)):
            _ending.add(id(target))
    if (change := _change(said)) and change[1] in _STATES:
        node, state = change[0], _STATES[change[1]]
        _lives[id(node)] = "active" if "active" in (state, _lives.get(id(node))) else state
