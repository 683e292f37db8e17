"""Convert recorded calls of launch actions to the YAML launch dialect."""

from __future__ import annotations

import os
from collections.abc import Callable

from graphflow.launchfiles.python.calls import code_of, is_off
from graphflow.launchfiles.python.events import (
    HANDLERS,
    LEFT_OUT,
    PROCESSES,
    STATES,
    handler_of,
    is_shutdown,
    state_change,
    without_functions,
)
from graphflow.launchfiles.python.nodes import common, components, condition_of, container, node, parameter, process
from graphflow.launchfiles.python.recording import RECORDING
from graphflow.launchfiles.python.stand_ins import Context, RecordedCall, called_as, no_equivalent, parts, plain, text
from graphflow.launchfiles.recorded import Action
from graphflow.markup.source import Data, scalar

# Calls are told apart by `id`: a launch file may give them any `__eq__`, and two equal nodes are two nodes.
_converted: dict[int, RecordedCall] = {}
"""Calls that have been converted, by id; the reference keeps the id from being reused."""
_numbers: dict[int, int] = {}
"""Numbers of actions that others come after, by id."""
_shutting_down: set[int] = set()
"""Ids of processes at whose exit the graph shuts down."""
_states: dict[int, str] = {}
"""Lifecycle states to which events bring nodes, by id."""
_carried_out: list[Action] = []
"""Actions that the launch file's code has executed itself, during the current call."""


def actions(described: object) -> list[dict[str, Data]]:
    """Convert a description, or actions in lists, to actions of the YAML launch dialect, as JSON."""
    return [action.to_json() for action in _actions(described)]


def _actions(described: object) -> list[Action]:
    if isinstance(described, (list, tuple)):
        found: list[Action] = []
        early = []
        for one in described:
            if _is_early(one):
                early.append(one)
            else:
                found += _actions(one)
        return found + [action for one in early for action in _actions(one)]
    if described is None:
        return []
    if not isinstance(described, RecordedCall):
        shown = f"the class {described.__name__}" if isinstance(described, type) else repr(described)
        RECORDING.problems.append(
            {"line": RECORDING.written_at, "message": f"{shown} is not an action, such as Node(...)"}
        )
        return []
    return _of_call(described)


def _of_call(call: RecordedCall) -> list[Action]:
    """Convert a call to the actions that it makes, and those that follow it."""
    _converted[id(call)] = call
    RECORDING.written_at = call.line
    _note_setting(call)
    code = code_of(call)
    if code is not None:
        return [] if is_off(call) else _made_by(code, call)
    convert = _CONVERTERS.get(call.kind)
    if convert is None:
        RECORDING.problem(call, no_equivalent(call))
        return []
    action = convert(call)
    if isinstance(action, list):
        return action
    action.line = call.line
    action.attributes |= condition_of(call)
    action.number = _numbers.get(id(call))
    action.brought_to = _states.get(id(call))
    if id(call) in _shutting_down:
        action.attributes["on_exit"] = "shutdown"
    return [action, *_after_exit(call)]


# settings and groups


def _argument(call: RecordedCall) -> Action:
    found: dict[str, Data] = {
        "name": text(call.get("name", 0)),
        "description": text(call.get("description", default="")),
    }
    if call.get("default_value") is not None:
        found["default"] = text(call.get("default_value"))
    if call.get("choices"):
        found["choice"] = [{"value": text(choice)} for choice in call.get("choices")]
    return Action("arg", found)


def _named_value(call: RecordedCall) -> dict[str, Data]:
    return {"name": text(call.get("name", 0)), "value": text(call.get("value", 1))}


def _append_env(call: RecordedCall) -> Action:
    found = {**_named_value(call), "prepend": str(call.get("prepend", 2, default=False))}
    if call.get("separator", 3) is not None:
        found["separator"] = text(call.get("separator", 3))
    return Action("append_env", found)


def _set_parameter(call: RecordedCall) -> Action:
    found = parameter(call.get("name", 0), call.get("value", 1))
    # The YAML dialect would parse a text as YAML; in Python it is a string.
    if isinstance(found["value"], str) and "$(" not in found["value"]:
        found = {"type": "str", **found}
    return Action("set_parameter", found)


def _set_remap(call: RecordedCall) -> Action:
    return Action("set_remap", {"from": text(call.get("src", 0)), "to": text(call.get("dst", 1))})


def _group(call: RecordedCall) -> Action:
    is_scoped, outer = bool(call.get("scoped", default=True)), (dict(RECORDING.set), dict(RECORDING.env))
    own = {text(key): text(value) for key, value in (call.get("launch_configurations", default=None) or {}).items()}
    RECORDING.set |= own
    settings = [Action("let", {"name": name, "value": value}, call.line) for name, value in own.items()]
    children = [*settings, *_actions(_actions_argument(call, 0))]
    # launch restores configurations and environment at the end of a scoped group; functions after it see neither.
    if is_scoped:
        RECORDING.set, RECORDING.env = outer
    return Action("group", {"scoped": is_scoped}, children=children)


def _timer(call: RecordedCall) -> Action:
    return Action("timer", {"period": _period(call)}, children=_actions(_actions_argument(call)))


def _include(call: RecordedCall) -> Action:
    given = call.get("launch_arguments", default=None) or ()
    if isinstance(given, dict):  # ROS 2 unpacks each name as if it were a pair, and fails
        RECORDING.problem(call, f"{call.kind}: launch_arguments is a list of pairs: write .items() behind the dict")
    arguments = dict(given)
    pairs: list[Data] = [{"name": text(key), "value": text(value)} for key, value in arguments.items()]
    return Action("include", {"file": text(call.get("launch_description_source", 0)), "arg": pairs})


def _actions_argument(call: RecordedCall, position: int = -1) -> object:
    given = call.get("actions", position, [])
    if not isinstance(given, RecordedCall):
        return given
    RECORDING.problem(call, f"{call.kind}: actions is a list: write [ ] around {called_as(given)}")
    return []


def _period(call: RecordedCall) -> Data:
    """Return the seconds of a timer, or a substitution for them; anything else is reported as a problem."""
    given = call.get("period")
    value = plain(given)
    if isinstance(value, str) and ("$(" in value or isinstance(scalar(value), (int, float))):
        return value
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return value
    if given is not None or not call.args:  # a period by position is already reported
        RECORDING.problem(call, f"{call.kind}: period is a number of seconds, such as 2.0, not {given!r}")
    return 1.0


# nodes and processes


def _node(call: RecordedCall) -> Action:
    autostart: dict[str, Data] = {"autostart": "true"} if call.get("autostart") is True else {}
    return Action("node", {**node(call), **autostart})


def _load_components(call: RecordedCall) -> Action:
    target = call.get("target_container")
    is_action = isinstance(target, RecordedCall) and target.kind == "ComposableNodeContainer"
    name = text(target.get("name") if is_action else target)
    return Action("load_composable_node", {"target": name, "composable_node": components(call)})


def _execute(call: RecordedCall) -> Action:
    first, *rest = call.get("cmd", 0, [""])
    if isinstance(first, RecordedCall) and first.kind == "ExecutableInPackage":  # a node that is started as a process
        of_node = {"pkg": text(first.get("package", 1)), "exec": text(first.get("executable", 0))}
        return Action("node", {**common(call), **of_node, "args": [text(word) for word in rest]})
    return Action("executable", process(call))


# events


def _emit(call: RecordedCall) -> Action | list[Action]:
    change = state_change(call)
    if change is None:
        if is_shutdown(call):
            return _shutdown(call)
        RECORDING.problem(call, no_equivalent(call))
        return []
    target, transition = change
    if transition in STATES:  # `number_targets` has noted the state at the node
        return []
    parts = text([target.get("namespace", default=""), "/", target.get("name", default="")]).split("/")
    name = "/".join(["", *filter(None, parts)])
    return Action("executable", {**common(call), "cmd": ["ros2", "lifecycle", "set", name, transition]})


def _shutdown(call: RecordedCall) -> Action:
    event = call if call.kind == "Shutdown" else call.get("event", 0)
    return Action("shutdown", {"reason": text(event.get("reason", 0, default="")) or "requested by a launch file"})


def _register(call: RecordedCall) -> list[Action]:
    """Convert an event handler to its actions, which begin after its event."""
    if is_off(call):
        return []
    handler = call.get("event_handler", 0)
    if isinstance(handler, RecordedCall) and handler.kind in LEFT_OUT:
        RECORDING.remark(call, LEFT_OUT[handler.kind])
        return []
    if not isinstance(handler, RecordedCall) or handler.kind not in HANDLERS:
        RECORDING.problem(call, f"an event handler {getattr(handler, 'name', '')} has no equivalent in a graph file")
        return []
    form = HANDLERS[handler.kind]
    target = handler.get(form.target)
    if callable(target) and not isinstance(target, RecordedCall):
        RECORDING.problem(call, f"{handler.kind}: only for one process, and not for those that a function chooses")
        return []
    then, functions = without_functions(handler.get(form.then))
    if functions or not isinstance(target, RecordedCall):
        whose = "a function" if functions else "what it does for every process"
        RECORDING.remark(call, f"{handler.kind}: {whose} is left out: nothing is called while the graph runs")
    if not isinstance(target, RecordedCall):
        return []
    goal = handler.get("goal_state")
    if not _reaches(target, goal):
        why = f"nothing in this file brings the node to {goal!r} by EmitEvent(event=ChangeState(...))"
        RECORDING.problem(call, f"OnStateTransition: {why}")
        return []
    if id(target) in _shutting_down and all(map(is_shutdown, then)):  # it has `on_exit: shutdown`
        return []
    return _after(target, then, form.outcome)


def _reaches(call: RecordedCall, state: object) -> bool:
    """Return whether events bring a lifecycle node to a state, perhaps on the way to another; None is any state."""
    final = _states.get(id(call))
    return state is None or (final is not None and state in (final, "inactive"))


def _after(target: RecordedCall, then: list[RecordedCall], outcome: str) -> list[Action]:
    """Convert actions that begin when another has come to an outcome."""
    number = _numbers.setdefault(id(target), len(_numbers) + 1)
    found = _actions(then)
    for action in found:
        action.after_number, action.after_what = number, outcome
    return found


def _after_exit(call: RecordedCall) -> list[Action]:
    """Convert the `on_exit` actions of a process."""
    then, functions = without_functions(call.get("on_exit") if call.kind in PROCESSES else None)
    if functions:
        RECORDING.remark(call, "on_exit: a function is left out: nothing is called while the graph runs")
    then = [one for one in then if not is_shutdown(one)]
    return _after(call, then, "exited") if then else []


def _is_early(described: object) -> bool:
    """Return whether an action registers an event handler before the action that it waits for."""
    registered = handler_of(described)
    if registered is None:
        return False
    handler, form = registered
    return id(handler.get(form.target)) not in _converted


def number_targets(described: object) -> None:
    """Number the actions that event handlers wait for, and note the effects of events on them.

    Call it before `actions`: an action's number must be known when the action is converted.
    """
    todo, seen = [described], set[int]()
    is_complete = True
    targets: list[tuple[RecordedCall, object]] = []
    """Event handlers, each with the action that it waits for."""
    while todo:
        one = todo.pop()
        if isinstance(one, (list, tuple)):
            # The stack gives them back in the file's order, by which they are numbered.
            todo += reversed(one)
        elif isinstance(one, RecordedCall) and id(one) not in seen:  # a description may contain itself
            seen.add(id(one))
            _number(one)
            is_complete = is_complete and one.kind != "OpaqueFunction"  # which returns further actions
            target = one.get(HANDLERS[one.kind].target) if one.kind in HANDLERS else None
            targets += [(one, target)] if isinstance(target, RecordedCall) else []
            todo += [part for part in reversed(parts(one)) if part is not target]
    for handler, target in targets if is_complete else ():
        if isinstance(target, RecordedCall) and id(target) not in seen:
            text = f"the target of {handler.kind} is in no description, and never starts: name it, as in node = "
            RECORDING.remark(handler, f"{text}{target.kind}(...), and put node into LaunchDescription([...]), too")


def _number(call: RecordedCall) -> None:
    if call.kind in PROCESSES and call.get("on_exit") is not None:
        _numbers.setdefault(id(call), len(_numbers) + 1)
    form = HANDLERS.get(call.kind)
    if form is not None and isinstance(target := call.get(form.target), RecordedCall):
        _numbers.setdefault(id(target), len(_numbers) + 1)
        then, _ = without_functions(call.get(form.then) if form.then in ("on_exit", "on_completion") else None)
        if then and all(map(is_shutdown, then)):
            _shutting_down.add(id(target))
    if (change := state_change(call)) and change[1] in STATES:
        lifecycle_node, state = change[0], STATES[change[1]]
        _states[id(lifecycle_node)] = "active" if "active" in (state, _states.get(id(lifecycle_node))) else state


# code of the launch file

_SETTINGS = ("SetLaunchConfiguration", "SetEnvironmentVariable", "AppendEnvironmentVariable")


def _note_setting(call: RecordedCall) -> None:
    """Record the effect of an action on configurations or the environment, for functions that are called later."""
    given = call.kwargs.get("condition")
    if call.kind not in _SETTINGS or RECORDING.values is None or (given is not None and not given.evaluate()):
        return
    name, value = (RECORDING.known(text(call.get(key, i))) for i, key in enumerate(("name", "value")))
    if call.kind == "SetLaunchConfiguration":
        RECORDING.set[name] = value
        return
    former = Context().environment.get(name)
    if call.kind == "AppendEnvironmentVariable" and former is not None:
        parts = [former, value]
        is_first = bool(call.get("prepend", 2, default=False))
        value = text(call.get("separator", 3, os.pathsep)).join(parts[::-1] if is_first else parts)
    RECORDING.env[name] = value


def _carry_out(call: object) -> None:
    """Convert an action where the launch file's code calls its `execute` or `visit`."""
    number_targets(call)
    _carried_out.extend(_actions(call))


RECORDING.carry_out = _carry_out


def _made_by(code: Callable[[], list[object]], call: RecordedCall) -> list[Action]:
    """Call code of the launch file; returns the actions that it sets, carries out itself and returns."""
    if RECORDING.values is None and call.kind in ("ForEach", "ForLoop"):  # the values of the loop are not known yet
        RECORDING.problem(
            call, f"{call.kind} has no equivalent in a graph file; `graphflow launch` starts the file as it is"
        )
        return []
    if RECORDING.values is None:
        message = f"{call.kind}: it was called once, with $(var ...) in place of each value; check its result"
        RECORDING.problem(call, message)
    # Saved, since this code may execute an action with code of its own.
    outer, before = _carried_out[:], dict(RECORDING.set)
    _carried_out.clear()
    returned = code()
    number_targets(returned)
    number_targets(RECORDING.descriptions)  # the code may have added to them
    changed = {name: value for name, value in RECORDING.set.items() if before.get(name) != value}
    settings = [Action("let", {"name": name, "value": value}, call.line) for name, value in changed.items()]
    inner, _carried_out[:] = _carried_out[:], outer
    return [*settings, *inner, *_actions(returned)]


_CONVERTERS: dict[str, Callable[[RecordedCall], Action | list[Action]]] = {
    "LaunchDescription": lambda call: _actions(call.entities),
    "ReplaceEnvironmentVariables": lambda _: [],
    "DeclareLaunchArgument": _argument,
    "SetLaunchConfiguration": lambda call: Action("let", _named_value(call)),
    "SetEnvironmentVariable": lambda call: Action("set_env", _named_value(call)),
    "AppendEnvironmentVariable": _append_env,
    "SetParameter": _set_parameter,
    "SetParametersFromFile": lambda call: Action(
        "set_parameters_from_file", {"filename": text(call.get("filename", 0))}
    ),
    "SetRemap": _set_remap,
    "SetUseSimTime": lambda call: Action("set_use_sim_time", {"value": plain(call.get("value", 0))}),
    **dict.fromkeys(
        ("PushRosNamespace", "PushROSNamespace"),
        lambda call: Action("push_ros_namespace", {"namespace": text(call.get("namespace", 0))}),
    ),
    "GroupAction": _group,
    **dict.fromkeys(("TimerAction", "RosTimer", "ROSTimer"), _timer),
    "IncludeLaunchDescription": _include,
    **dict.fromkeys(("LogInfo", "Log"), lambda call: Action("log", {"message": text(call.get("msg", default=""))})),
    "UnregisterEventHandler": lambda _: [],
    "RegisterEventHandler": _register,
    "EmitEvent": _emit,
    "Shutdown": _shutdown,
    **dict.fromkeys(("Node", "LifecycleNode"), _node),
    "ComposableNodeContainer": lambda call: Action("node_container", container(call)),
    "LoadComposableNodes": _load_components,
    **dict.fromkeys(("ExecuteProcess", "ExecuteLocal"), _execute),
}
"""Converters by the class of a call; they return an action, or the actions in place of the call."""
