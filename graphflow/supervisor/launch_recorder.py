"""A launch file in Python, run in a process of its own against stand-ins that record what it describes.

    python -m graphflow.supervisor.launch_recorder FILE      ->      {"actions": [...], "problems": [...]} on stdout

The stand-ins have the names of `launch`, `launch_ros` and `ament_index_python`. What they are called with is written
down as the actions of ROS's YAML dialect, each with its line; substitutions become their texts, `$(var x)`. So a value
that only a running launch would know stays a text, and Python that decides by such a value decides only once.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import shlex
import sys
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

_FILE = ""
"""The launch file, as its frames name it."""
_problems: list[dict[str, Any]] = []
_numbers: dict[int, int] = {}
"""Numbers of actions that others come after."""
_ending: set[int] = set()
"""Actions with whose end everything ends."""


def _line() -> int:
    """The line of the launch file that is being carried out."""
    frame = sys._getframe(1)
    while frame is not None and frame.f_code.co_filename != _FILE:
        frame = frame.f_back  # type: ignore[assignment]
    return frame.f_lineno if frame is not None else 1


class Said:
    """A call of one of the stand-ins."""

    name = ""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self.args, self.kwargs, self.line = args, kwargs, _line()

    def get(self, key: str, place: int = -1, default: Any = None) -> Any:
        """An argument by its name, or by its place among those without."""
        if key in self.kwargs:
            return self.kwargs[key]
        return self.args[place] if 0 <= place < len(self.args) else default

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *_, **__: None

    def add_action(self, action: Any) -> None:
        """As a LaunchDescription has it."""
        self.__dict__.setdefault("added", []).append(action)

    def find(self, package: Any = None) -> str:
        """As a FindPackageShare has it."""
        return f"$(find-pkg-share {text(package)})"

    def perform(self, context: Any = None) -> str:
        return text(self)

    def __str__(self) -> str:
        return text(self)

    def __add__(self, other: Any) -> str:
        return text(self) + text(other)

    def __radd__(self, other: Any) -> str:
        return text(other) + text(self)

    def __fspath__(self) -> str:
        return text(self)


def text(value: Any) -> str:
    """A value with its substitutions, as launch files in YAML have it."""
    if isinstance(value, (list, tuple)):
        return "".join(map(text, value))
    if not isinstance(value, Said):
        return str(value)
    first = value.args[0] if value.args else next(iter(value.kwargs.values()), "")
    match value.name:
        case "LaunchConfiguration":
            return f"$(var {text(first)})"
        case "EnvironmentVariable":
            default = value.get("default_value", 1)
            return f"$(env {text(first)}{'' if default is None else f' {text(default)}'})"
        case "FindPackageShare" | "FindPackagePrefix":
            return f"$(find-pkg-{value.name[11:].lower()} {text(first)})"
        case "ExecutableInPackage":
            return f"$(exec-in-pkg {text(value.get('executable', 0))} {text(value.get('package', 1))})"
        case "PathJoinSubstitution":
            return "/".join(text(part).strip("/") if i else text(part) for i, part in enumerate(first))
        case "PythonExpression":
            return f"$(eval {text(first)})"
        case "ThisLaunchFileDir":
            return "$(dirname)"
        case "ThisLaunchFile":
            return "$(filename)"
        case "LaunchLogDir" | "LogDir":
            return "$(log_dir)"
        case "Parameter":
            return f"$(param {text(first)})"
        case "IfElseSubstitution":
            return f"$(if {' '.join(map(_quoted, (*value.args, *value.kwargs.values())))})"
        case "AnySubstitution" | "AllSubstitution":
            return f"$({value.name[:3].lower()} {' '.join(map(_quoted, value.args))})"
        case "Command":
            on_stderr = value.get("on_stderr", 1)
            return f"$(command {_quoted(first)}{'' if on_stderr is None else f' {text(on_stderr)}'})"
        case "FileContent":
            return f"$(file-content {text(first)})"
        case "FindExecutable":
            return f"$(find-exec {text(first)})"
        case "AnonName":
            return f"$(anon {text(first)})"
        case "NotSubstitution":
            return f"$(not {text(first)})"
        case "EqualsSubstitution" | "NotEqualsSubstitution" | "AndSubstitution" | "OrSubstitution":
            word = {"Equals": "equals", "NotEquals": "not-equals", "And": "and", "Or": "or"}[value.name[:-12]]
            return f"$({word} {' '.join(map(_quoted, value.args))})"
        case "TextSubstitution" | "ParameterValue" | "ParameterFile" | "PythonLaunchDescriptionSource":
            return text(first)
        case name if name.endswith("LaunchDescriptionSource"):
            return text(first)
    _problem(value, f"{value.name} has no words in a graph file")
    return ""


def _quoted(value: Any) -> str:
    return shlex.quote(text(value))


def _problem(value: Said, message: str) -> None:
    _problems.append({"line": value.line, "message": message})


# actions


def actions(said: Any) -> list[dict[str, Any]]:
    """What was described, as actions of the YAML dialect."""
    if isinstance(said, (list, tuple)):
        return [action for one in said for action in actions(one)]
    if said is None:
        return []
    if not isinstance(said, Said):
        _problems.append({"line": 1, "message": f"{said!r} is no action"})
        return []
    name, attributes = _action(said)
    if name == "":
        return list(attributes)
    attributes |= {"line": said.line, **_condition(said)}
    if id(said) in _numbers:
        attributes["number"] = _numbers[id(said)]
    if id(said) in _ending:
        attributes["on_exit"] = "shutdown"
    return [{name: attributes}]


def _condition(said: Said) -> dict[str, Any]:
    condition = said.kwargs.get("condition")
    words = {"IfCondition": "if", "UnlessCondition": "unless"}
    if not isinstance(condition, Said):
        return {}
    if condition.name in words:
        return {words[condition.name]: text(condition.args[0] if condition.args else "")}
    if condition.name in ("LaunchConfigurationEquals", "LaunchConfigurationNotEquals"):
        word = "equals" if condition.name.endswith("nEquals") else "not-equals"
        variable, value = condition.args
        return {"if": f"$({word} $(var {text(variable)}) {text(value)})"}
    _problem(condition, f"{condition.name} has no words in a graph file")
    return {}


def _action(said: Said) -> tuple[str, Any]:
    get = said.get
    match said.name:
        case "LaunchDescription" | "ReplaceEnvironmentVariables":
            return "", actions(get("initial_entities", 0, []))
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
            return "append_env", {**found, "prepend": str(get("prepend", 2, default=False))}
        case "SetParameter":
            return "set_parameter", {"name": text(get("name", 0)), "value": plain(get("value", 1))}
        case "SetRemap":
            return "set_remap", {"from": text(get("src", 0)), "to": text(get("dst", 1))}
        case "SetUseSimTime":
            return "set_use_sim_time", {"value": plain(get("value", 0))}
        case "PushRosNamespace" | "PushROSNamespace":
            return "push_ros_namespace", {"namespace": text(get("namespace", 0))}
        case "GroupAction":
            return "group", {"children": actions(get("actions", 0, [])), "scoped": bool(get("scoped", default=True))}
        case "TimerAction":
            return "timer", {"period": plain(get("period")), "children": actions(get("actions", default=[]))}
        case "IncludeLaunchDescription":
            arguments = dict(get("launch_arguments", default=None) or {})
            pairs = [{"name": text(key), "value": text(value)} for key, value in arguments.items()]
            return "include", {"file": text(get("launch_description_source", 0)), "arg": pairs}
        case "LogInfo" | "UnregisterEventHandler":
            return "log", {"message": text(get("msg", default=""))}
        case "OpaqueFunction":
            return "", actions(_called(said))
        case "RegisterEventHandler":
            return "", _handled(said)
        case "Node" | "LifecycleNode":
            found = {"autostart": "true"} if get("autostart") is True else {}
            return "node", {**_node(said), **found}
        case "ComposableNodeContainer":
            for key in sorted(_OF_PROCESSES & {key for key, value in said.kwargs.items() if value}):
                _problem(said, f"{key}: its container is a process that nodes share; write it at the nodes")
            return "node_container", {"name": text(get("name")), "composable_node": _components(said)}
        case "LoadComposableNodes":
            target = get("target_container")
            name = text(target.get("name") if isinstance(target, Said) else target)
            return "load_composable_node", {"target": name, "composable_node": _components(said)}
        case "ExecuteProcess" | "ExecuteLocal":
            first, *rest = get("cmd", 0, [""])
            if isinstance(first, Said) and first.name == "ExecutableInPackage":  # a node, by another way
                found = {"pkg": text(first.get("package", 1)), "exec": text(first.get("executable", 0))}
                return "node", {**_common(said), **found, "args": [text(word) for word in rest]}
            return "executable", _process(said)
    _problem(said, f"{said.name} has no words in a graph file")
    return "", []


def _called(said: Said) -> Any:
    function = said.get("function", 0)
    _problem(said, "OpaqueFunction: it was called once, with $(var ...) in place of each value; look what it made")
    return function(Said(), *(said.get("args", default=None) or []), **(said.get("kwargs", default=None) or {}))


def _handled(said: Said) -> list[dict[str, Any]]:
    """Actions that begin when a process has started or ended."""
    handler = said.get("event_handler", 0)
    names = {"OnProcessExit": ("on_exit", "exited"), "OnProcessStart": ("on_start", "ready")}
    if not isinstance(handler, Said) or handler.name not in names:
        _problem(said, f"an event handler {getattr(handler, 'name', '')} has no words in a graph file")
        return []
    key, what = names[handler.name]
    target, then = handler.get("target_action"), handler.get(key)
    if not isinstance(target, Said) or (callable(then) and not isinstance(then, Said)):
        _problem(said, f"{handler.name}: only for one process, with a list of actions")
        return []
    then = [one for one in (then if isinstance(then, list) else [then]) if not _is_shutdown(one)]
    number = _numbers.setdefault(id(target), len(_numbers) + 1)
    found = actions(then)
    for action in found:
        for attributes in action.values():
            attributes["after_number"], attributes["after_what"] = number, what
    return found


def _common(said: Said) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key in ("name", "namespace", "cwd", "respawn", "respawn_delay", "respawn_max_retries", "shell"):
        if said.get(key) is not None:
            found[key] = text(said.get(key))
    variables = {**(said.get("env") or {}), **(said.get("additional_env") or {})}
    if variables:
        found["env"] = [{"name": text(key), "value": text(value)} for key, value in variables.items()]
    on_exit = said.get("on_exit")
    if on_exit is not None:
        if isinstance(on_exit, Said) and on_exit.name in ("Shutdown", "EmitEvent"):
            found["on_exit"] = "shutdown"
        else:
            _problem(said, "on_exit: only Shutdown() has words in a graph file")
    return found


def _process(said: Said) -> dict[str, Any]:
    return {**_common(said), "cmd": [text(word) for word in said.get("cmd", 0, [])]}


def _node(said: Said) -> dict[str, Any]:
    found = {**_common(said), "pkg": text(said.get("package")), "exec": text(said.get("executable"))}
    for key, ours in (("arguments", "args"), ("ros_arguments", "ros_args")):
        if said.get(key):
            found[ours] = [text(word) for word in said.get(key)]
    if said.get("remappings"):
        found["remap"] = [{"from": text(old), "to": text(new)} for old, new in said.get("remappings")]
    params: list[dict[str, Any]] = []
    for given in said.get("parameters") or []:
        if isinstance(given, dict):
            params += [_parameter(key, value) for key, value in given.items()]
        else:
            params.append({"from": text(given)})
    if params:
        found["param"] = params
    return found


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
"""What a container may be given that its nodes here must be given."""


def _components(said: Said) -> list[dict[str, Any]]:
    described = said.get("composable_node_descriptions") or []
    nodes = [one for one in described if isinstance(one, Said)]
    return [
        {**{k: v for k, v in _node(one).items() if k != "exec"}, "plugin": text(one.get("plugin"))} for one in nodes
    ]


def _parameter(name: Any, value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        return {"name": text(name), "param": [_parameter(key, inner) for key, inner in value.items()]}
    is_text = isinstance(value, str) and "$(" not in value
    return {"name": text(name), "value": plain(value), **({"type": "str"} if is_text else {})}


def plain(value: Any) -> Any:
    """A value as JSON has it: numbers stay numbers."""
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (list, tuple)):
        return text(value) if any(isinstance(part, Said) for part in value) else [plain(part) for part in value]
    return text(value)


# the modules


_SUBMODULES = {"actions", "substitutions", "conditions", "events", "event_handlers", "launch_description_sources"}
_SUBMODULES |= {"descriptions", "parameter_descriptions", "packages"}


class _Environment(dict[str, str]):
    """The environment; a variable that is not set is a substitution, so that a path made of it is one, too."""

    def __missing__(self, name: str) -> str:
        return f"$(env {name})"


class _StandIn(ModuleType):
    """A module that has whatever is asked for."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        made: Any
        if name in _SUBMODULES:  # also for those who have only imported `launch`
            made = import_module(f"{self.__name__}.{name}")
        else:
            made = type(name, (Said,), {"name": name}) if name[:1].isupper() else _function(name)
        setattr(self, name, made)
        return made


def _function(name: str) -> Any:
    if name in ("get_package_share_directory", "get_package_share_path", "get_package_prefix"):
        return lambda package, *_: f"$(find-pkg-{'prefix' if name.endswith('prefix') else 'share'} {package})"
    return lambda *_, **__: None


class _Finder(MetaPathFinder, Loader):
    """Finds a stand-in for every module of ROS's launch packages."""

    packages = ("launch", "launch_ros", "launch_xml", "launch_yaml", "ament_index_python")

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        return ModuleSpec(name, self, is_package=True) if name.partition(".")[0] in self.packages else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        return _StandIn(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Nothing is in it before it is asked for."""


def record(path: str) -> dict[str, Any]:
    """Run a launch file; returns its actions, and what could not be written down."""
    global _FILE
    _FILE = path
    sys.meta_path.insert(0, _Finder())
    os.environ = _Environment(os.environ)  # type: ignore[assignment]  # noqa: B003 - Python alone is to see it
    found: list[dict[str, Any]] = []
    try:
        with open(path, encoding="utf-8") as file:
            code = compile(file.read(), path, "exec")
        space: dict[str, Any] = {"__name__": "launch_file", "__file__": path}
        exec(code, space)  # noqa: S102 - the user's own file, in a process of its own
        if "generate_launch_description" not in space:
            raise NameError("it has no function generate_launch_description()")
        described = space["generate_launch_description"]()
        whole = [described, *described.__dict__.get("added", [])]
        _number_targets(whole)
        found = actions(whole)
    except Exception as error:  # whatever a user's file does
        trace, line = error.__traceback__, getattr(error, "lineno", None) or 1
        while trace is not None:
            if trace.tb_frame.f_code.co_filename == path:
                line = trace.tb_lineno
            trace = trace.tb_next
        _problems.append({"line": line, "message": f"{type(error).__name__}: {error}"})
    return {"actions": found, "problems": _problems}


def _is_shutdown(said: Any) -> bool:
    return isinstance(said, Said) and said.name in ("EmitEvent", "Shutdown")


def _number_targets(said: Any) -> None:
    """Number the actions that event handlers wait for, before they are written down."""
    if isinstance(said, (list, tuple)):
        for one in said:
            _number_targets(one)
    elif isinstance(said, Said):
        if said.name in ("OnProcessExit", "OnProcessStart") and isinstance(target := said.get("target_action"), Said):
            _numbers.setdefault(id(target), len(_numbers) + 1)
            then = said.get("on_exit")
            if any(_is_shutdown(one) for one in (then if isinstance(then, list) else [then])):
                _ending.add(id(target))
        _number_targets([*said.args, *said.kwargs.values()])


def main() -> None:
    out = os.dup(1)
    os.dup2(2, 1)  # what the file prints is not the answer
    with contextlib.redirect_stdout(io.StringIO()):
        found = record(os.path.abspath(sys.argv[1]))
    os.write(out, json.dumps(found).encode())


if __name__ == "__main__":
    main()
