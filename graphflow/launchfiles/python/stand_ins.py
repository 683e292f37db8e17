"""Stand-ins for ROS's launch packages, which remember what they are called with, and with which line.

They have the names of `launch`, `launch_ros` and `ament_index_python`. Substitutions become their texts, `$(var x)`; so
a value that only a running launch would know stays a text, unless a function asks for it (`perform`) when the file is
about to be started.
"""

from __future__ import annotations

import json
import logging
import os
import sys
from collections import UserDict
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import Any

from graphflow.folders import newest_logs
from graphflow.launchfiles.python.names import BASES, NAMES, home
from graphflow.launchfiles.python.parameters import PARAMETERS, Parameters, not_texts, wrong
from graphflow.markup.substitution_words import QUOTES, as_word
from graphflow.markup.substitutions import Outside, Run, SubstitutionError, Substitutions, truth
from graphflow.names import nearest
from graphflow.workspace.executables import package_prefix, package_share
from graphflow.workspace.project import project_root

PACKAGES = ("launch", "launch_ros", "launch_xml", "launch_yaml", "ament_index_python")
"""The packages that there are stand-ins for."""


class PackageNotFoundError(KeyError):
    """As of ament_index_python: there is no such package."""

    def __str__(self) -> str:
        return f"package {self.args[0]!r} not found; it is neither in the workspace nor installed"


class Recording:
    """One launch file, and what is known of it while it is run."""

    def __init__(self) -> None:
        self.file = ""
        """Its path, as its frames name it."""
        self.values: dict[str, str] | None = None
        """The arguments that it is to be started with; None if it is only written down."""
        self.defaults: dict[str, str] = {}
        """Those of the arguments that have been declared so far."""
        self.needed: set[str] = set()
        """The arguments that have been declared without one."""
        self.set: dict[str, str] = {}
        """The launch configurations that have been set so far."""
        self.env: dict[str, str] = {}
        """The variables of the environment that have been set so far."""
        self.descriptions: list[Said] = []
        """All that were made, to which a function may add while it is called."""
        self.problems: list[dict[str, Any]] = []
        """What has no words in a graph file, each with its `line` and a `message`."""
        self.remarks: list[dict[str, Any]] = []
        """What is left out, likewise."""
        self.written_at = 1
        """The line of the action that was written down last."""
        self.run: Run | None = None
        """Carries out `$(command ...)`; without it, such a substitution stays as it is written."""
        self.carry_out: Callable[[Said], None] = lambda _: None
        """Writes down an action that code of the file carries out itself."""

    def problem(self, said: Said, message: str) -> None:
        """Add one."""
        self.problems.append({"line": said.line, "message": message})

    def remark(self, said: Said, message: str) -> None:
        """Say that something is left out."""
        self.remarks.append({"line": said.line, "message": message})

    def line(self) -> int:
        """The line of the file that is being carried out."""
        frame = sys._getframe(1)
        while frame is not None and frame.f_code.co_filename != self.file:
            frame = frame.f_back  # type: ignore[assignment]
        return frame.f_lineno if frame is not None else 1

    def known(self, text: str) -> str:
        """A text with its substitutions made, if the file is to be started.

        Raises:
            SubstitutionError: A substitution cannot be made.
        """
        if self.values is None:
            return text
        missing = next(
            (name for name in self.needed - self.values.keys() - self.defaults.keys() if f"$(var {name})" in text), None
        )
        if missing is not None:
            raise SubstitutionError(f"the argument {missing!r} has no default; give {missing}:=VALUE")
        return self._made(text, self.arguments())

    def arguments(self) -> dict[str, str]:
        """The values of launch configurations that are known: what is given, defaults, and what has been set."""
        found = dict(self.values or {})
        for name, default in self.defaults.items():
            if name not in found:
                found[name] = self._made(default, found)
        return found | self.set

    def _made(self, text: str, values: Mapping[str, str]) -> str:
        file = Path(self.file)
        env = {**os.environ, **self.env}
        outside = Outside(env, project_root(file), newest_logs(file.name.removesuffix(".launch.py")), self.run)
        return as_text(Substitutions(values, file, outside).apply(text))

    def folder(self, what: str, package: str) -> str:
        """The `share` folder or `prefix` of a package; the substitution for it, if the file is only written down.

        Raises:
            PackageNotFoundError: There is no such package.
        """
        if self.values is None:
            return f"$(find-pkg-{what} {package})"
        find = package_prefix if what == "prefix" else package_share
        found = find(package, project_root(Path(self.file)), os.environ)
        if found is None:
            raise PackageNotFoundError(package)
        return str(found)


RECORDING = Recording()
"""A process runs one launch file."""


def as_text(value: Any) -> str:
    """A value as launch configurations have it: they are all texts."""
    return value if isinstance(value, str) else json.dumps(value)


class Configurations(UserDict[str, str]):
    """Launch configurations, as a function sees and sets them."""

    def __init__(self) -> None:
        super().__init__()
        self.data.update(RECORDING.arguments())

    def __setitem__(self, name: str, value: Any) -> None:
        self.data[name] = RECORDING.set[name] = as_text(value)


class Context:
    """What an `OpaqueFunction` is called with."""

    @property
    def launch_configurations(self) -> Configurations:
        """The values of arguments, and of what has been set."""
        return Configurations()

    @property
    def environment(self) -> dict[str, str]:
        """The variables of the environment, with those that have been set."""
        return {**os.environ, **RECORDING.env}

    def perform_substitution(self, value: Any) -> str:
        """A value with its substitutions made."""
        return RECORDING.known(text(value))


class Said:
    """A call of one of the stand-ins."""

    kind = ""
    """The name of the class of ROS's; those of a launch file's own have their base's."""
    args: tuple[Any, ...] = ()
    kwargs: Mapping[str, Any] = MappingProxyType({})
    line = 1

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self.args, self.kwargs, self.line = args, kwargs, RECORDING.line()
        for message in (*wrong(self.kind, args, list(kwargs)), *not_texts(self.kind, args, kwargs)):
            RECORDING.problem(self, message)
        default = self.get("default_value")
        if self.kind == "DeclareLaunchArgument":
            name = text(self.get("name", 0))
            if default is None:
                RECORDING.needed.add(name)
            else:
                RECORDING.defaults[name] = text(default)
        if self.kind == "LaunchDescription":
            given = self.get("initial_entities", 0) or ()
            if isinstance(given, Said) or len(args) > 1:
                raise TypeError(f"LaunchDescription takes a list: write [ ] around {', '.join(map(repr, args))}")
            self.entities = list(given)
            RECORDING.descriptions.append(self)

    def __repr__(self) -> str:
        return f"{self.kind}(...)"

    def get(self, key: str, place: int = -1, default: Any = None) -> Any:
        """An argument by its name, or by its place among those without."""
        if key in self.kwargs:
            return self.kwargs[key]
        return self.args[place] if 0 <= place < len(self.args) else default

    def __getattr__(self, name: str) -> Any:
        """The argument that was given for a parameter; None for none."""
        if name in self.kwargs:
            return self.kwargs[name]
        known = PARAMETERS.get(self.kind, Parameters((), ()))
        if name not in known.names:
            raise AttributeError(f"{self.kind} has no {name!r} here: a launch file is read, and not run by launch")
        return self.get(name, known.by_place.index(name) if name in known.by_place else -1)

    def execute(self, context: Any = None) -> Any:
        """Carry an action out, here and now; those of a file's own return the actions that they make."""
        RECORDING.carry_out(self)
        return [] if self.kind in ("GroupAction", "IncludeLaunchDescription") else None

    def visit(self, context: Any = None) -> Any:
        """The same under its condition, which is written down with it."""
        return self.execute(context)

    def describe(self) -> str:
        """The call, as ROS's tools show it."""
        return f"{self.kind}({', '.join(map(text, self.args or self.kwargs.values()))})"

    def add_action(self, action: Any) -> None:
        """As a LaunchDescription has it, also while it is carried out."""
        if "entities" not in self.__dict__:
            raise AttributeError(f"{self.kind} has no add_action")
        self.entities.append(action)

    add_entity = add_action

    def find(self, package: Any = None) -> str:
        """As a FindPackageShare has it."""
        return RECORDING.folder("share", text(package))

    def perform(self, context: Any = None) -> str:
        """As a substitution has it."""
        return RECORDING.known(_written(self))

    def evaluate(self, context: Any = None) -> bool:
        """As a condition has it."""
        ((word, said),) = condition(self).items()
        return truth(RECORDING.known(said), RECORDING.file) is (word == "if")

    def __str__(self) -> str:
        return text(self)

    def __format__(self, spec: str) -> str:
        if BASES.get(self.kind) == "Substitution":
            RECORDING.remark(self, f"{self.kind} in an f-string is an object to ROS 2; write a list: ['text', ...]")
        return format(text(self), spec)

    def __add__(self, other: Any) -> str:
        raise TypeError(_no_sum(self, self, other))

    def __radd__(self, other: Any) -> str:
        raise TypeError(_no_sum(self, other, self))

    def __truediv__(self, other: Any) -> Any:
        """Join paths, as substitutions that are paths do."""
        return stand_in_of("PathJoinSubstitution")([self, other])

    def __rtruediv__(self, other: Any) -> Any:
        return stand_in_of("PathJoinSubstitution")([other, self])


def _no_sum(said: Said, *parts: Any) -> str:
    """What to say where something that only a launch knows is added to a text, as Python lets no one do with ROS 2."""
    shown = ", ".join(f"{part.kind}(...)" if isinstance(part, Said) else repr(part) for part in parts)
    return f"{said.kind} is no text before the launch, and has no +; write a list: [{shown}]"


def text(value: Any) -> str:
    """A value with its substitutions, as launch files in YAML have it."""
    if isinstance(value, (list, tuple)):
        return "".join(map(text, value))
    if not isinstance(value, Said):
        return str(value)
    if type(value).perform is not Said.perform and RECORDING.values is not None:  # a class of the file's own
        return text(value.perform(Context()))
    return _written(value)


def _written(value: Said) -> str:
    """A substitution of ROS's as a text."""
    first = value.args[0] if value.args else next(iter(value.kwargs.values()), "")
    match value.kind:
        case "LaunchConfiguration":
            default = value.get("default", 1)
            return f"$(var {_word(first)}{'' if default is None else f' {_word(default)}'})"
        case "EnvironmentVariable":
            default = value.get("default_value", 1)
            return f"$(env {_word(first)}{'' if default is None else f' {_word(default)}'})"
        case "FindPackageShare" | "FindPackagePrefix":
            return f"$(find-pkg-{value.kind[11:].lower()} {_word(first)})"
        case "ExecutableInPackage":
            return f"$(exec-in-pkg {_word(value.get('executable', 0))} {_word(value.get('package', 1))})"
        case "PathJoinSubstitution":
            return os.path.join("", *map(text, first))
        case "PythonExpression":
            expression = text(first)
            return f"$(eval {as_word(expression) if expression[:1] in QUOTES else expression})"
        case "ThisLaunchFileDir":
            return "$(dirname)"
        case "ThisLaunchFile":
            return "$(filename)"
        case "LaunchLogDir" | "LogDir":
            return "$(log_dir)"
        case "Parameter":
            default = value.get("default")
            return f"$(param {_word(first)}{'' if default is None else f' {_word(default)}'})"
        case "IfElseSubstitution":
            ways = (value.get("if_value", 1, ""), value.get("else_value", 2, ""))
            return f"$(if {' '.join(map(_word, (value.get('condition', 0), *ways)))})"
        case "AnySubstitution" | "AllSubstitution":
            return f"$({' '.join([value.kind[:3].lower(), *map(_word, value.args)])})"
        case "Command":
            on_stderr = value.get("on_stderr", 1)
            return f"$(command {_word(first)}{'' if on_stderr is None else f' {_word(on_stderr)}'})"
        case "FileContent":
            return f"$(file-content {_word(first)})"
        case "FindExecutable":
            return f"$(find-exec {_word(first)})"
        case "AnonName":
            return f"$(anon {_word(first)})"
        case "NotSubstitution":
            return f"$(not {_word(first)})"
        case "EqualsSubstitution" | "NotEqualsSubstitution" | "AndSubstitution" | "OrSubstitution":
            word = {"Equals": "equals", "NotEquals": "not-equals", "And": "and", "Or": "or"}[value.kind[:-12]]
            return f"$({word} {' '.join(_word('' if part is None else part) for part in value.args)})"
        case "TextSubstitution" | "PathSubstitution" | "ParameterValue" | "ParameterFile":
            return text(first)
        case name if name.endswith("LaunchDescriptionSource"):
            return text(first)
    RECORDING.problem(value, no_words(value))
    return ""


def _word(value: Any) -> str:
    """A value as a word of a substitution."""
    return as_word(text(value))


def condition(said: Said) -> dict[str, str]:
    """A condition, as the attribute that actions of the YAML dialect have for it."""
    words = {"IfCondition": "if", "UnlessCondition": "unless"}
    if said.kind in words:
        return {words[said.kind]: text(said.args[0] if said.args else "")}
    if said.kind in ("LaunchConfigurationEquals", "LaunchConfigurationNotEquals"):
        word = "equals" if said.kind.endswith("nEquals") else "not-equals"
        variable, value = said.args
        return {"if": f"$({word} $(var {_word(variable)}) {_word(value)})"}
    RECORDING.problem(said, no_words(said))
    return {}


def no_words(said: Said) -> str:
    """What to say of a class that graph files have nothing for, perhaps because its name is misspelt."""
    known = {name for names in NAMES.values() for name in names.split()}
    near = nearest(said.kind, known, cutoff=0.85) if said.kind not in known else None
    return f"{said.kind} has no words in a graph file" + (f"; did you mean {near!r}?" if near else "")


def plain(value: Any) -> Any:
    """A value as JSON has it: numbers stay numbers."""
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (list, tuple)):
        is_text = any(isinstance(part, Said) for part in value) and all(isinstance(part, (Said, str)) for part in value)
        if not is_text:  # each of its values is one, of which a list stands for a text
            return [text(part) if isinstance(part, (list, tuple)) else plain(part) for part in value]
    return text(value)


OWN: dict[str, Any] = {
    "PackageNotFoundError": PackageNotFoundError,
    "SubstitutionFailure": SubstitutionError,
    "InvalidConditionExpressionError": SubstitutionError,
    "LaunchContext": Context,
}
"""Classes that do more than remember, and functions, by name; the module that defines one adds it."""
_SUBMODULES = {"actions", "substitutions", "conditions", "events", "event_handlers", "launch_description_sources"}
_SUBMODULES |= {"descriptions", "parameter_descriptions", "packages", "lifecycle", "logging", "utilities"}
_SUBMODULES |= {"frontend", "some_substitutions_type", "type_utils"}


class _StandIn(ModuleType):
    """A module that has whatever is asked for."""

    def __getattr__(self, name: str) -> Any:
        if name == "__all__" and self.__name__ in NAMES:
            return NAMES[self.__name__].split()
        if name.startswith("__"):
            raise AttributeError(name)
        made = _made(self.__name__, name)
        setattr(self, name, made)
        return made


def _made(module: str, name: str) -> Any:
    """What a module of ROS's launch packages has under a name."""
    if name in _SUBMODULES:  # also for those who have only imported `launch`
        return import_module(f"{module}.{name}")
    elsewhere = home(module, name)
    if elsewhere is not None:
        raise ImportError(f"{module} has no {name}; write: from {elsewhere} import {name}", name=module)
    if name in OWN:
        return OWN[name]
    return stand_in_of(name) if name[:1].isupper() or name.startswith("matches_") else _function(module, name)


@cache
def stand_in_of(name: str) -> Any:
    """The class that stands for one of ROS's."""
    if name.endswith(("Error", "Failure", "Exception")):  # which a file may want to catch
        return type(name, (Exception,), {})
    base = stand_in_of(BASES[name]) if name in BASES else Said
    return type(name, (base,), {"kind": name})


def stand_in(package: str) -> Callable[[str], Any]:
    """The `__getattr__` of a package outside of launch files, whose modules can be imported from now on."""
    if not any(isinstance(finder, StandIns) for finder in sys.meta_path):
        sys.meta_path.append(StandIns())

    def get(name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return _made(package, name)

    return get


def _function(module: str, name: str) -> Any:
    what = "prefix" if name.endswith("prefix") else "share"
    if name in ("get_package_share_directory", "get_package_prefix"):
        return lambda package, *_: RECORDING.folder(what, package)
    if name in ("get_package_share_path", "get_package_prefix_path"):
        return lambda package, *_: Path(RECORDING.folder(what, package))
    if name == "get_logger":
        return logging.getLogger

    def missing(*_: Any, **__: Any) -> Any:
        raise NotImplementedError(
            f"{module}.{name} is not here: graphflow reads launch files without launch's own code"
        )

    return missing


class StandIns(MetaPathFinder, Loader):
    """Finds a stand-in for every module of ROS's launch packages."""

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        return ModuleSpec(name, self, is_package=True) if name.partition(".")[0] in PACKAGES else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        return _StandIn(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Nothing is in it before it is asked for."""
