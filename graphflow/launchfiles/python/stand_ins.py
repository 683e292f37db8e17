"""Stand-ins for ROS's launch packages, which record the calls of a launch file, each with its line.

They have the names of `launch`, `launch_ros` and `ament_index_python`. Substitutions become their texts, `$(var x)`: a
value that only a running launch would have stays a text, unless code calls `perform` when the file is being started.
"""

from __future__ import annotations

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
from typing import Any, NoReturn

from graphflow.launchfiles.python.names import BASES, NAMES, home
from graphflow.launchfiles.python.parameters import PARAMETERS, Parameters, not_texts, wrong
from graphflow.launchfiles.python.recording import RECORDING, PackageNotFoundError, as_text
from graphflow.markup.source import Data
from graphflow.markup.substitution_words import QUOTES, as_word
from graphflow.markup.substitutions import SubstitutionError, truth
from graphflow.names import nearest

PACKAGES = ("launch", "launch_ros", "launch_xml", "launch_yaml", "ament_index_python")
"""The packages with stand-ins."""


class Configurations(UserDict[str, str]):
    """Launch configurations, as functions of a launch file read and set them."""

    def __init__(self) -> None:
        super().__init__()
        self.data.update(RECORDING.arguments())

    def __setitem__(self, name: str, value: object) -> None:
        # A new mapping is made for each access, so what is set must outlive it.
        self.data[name] = RECORDING.set[name] = as_text(value)


class Context:
    """The launch context that functions of a launch file are called with."""

    @property
    def launch_configurations(self) -> Configurations:
        """The values of arguments, and those set so far."""
        return Configurations()

    @property
    def environment(self) -> dict[str, str]:
        """The environment, with the variables set so far."""
        return {**os.environ, **RECORDING.env}

    def perform_substitution(self, value: object) -> str:
        """Return a value with its substitutions made."""
        return RECORDING.known(text(value))


class RecordedCall:
    """A recorded call of a class of ROS's launch packages; the base class of their stand-ins."""

    kind = ""
    """The name of the class; classes of the launch file itself have that of their base."""
    # The arguments may be anything, and code of the launch file uses them without type checks, as it does with ROS 2.
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
            self.entities: list[object]
            if isinstance(given, RecordedCall) or len(args) > 1:
                raise TypeError(f"LaunchDescription takes a list: write [ ] around {', '.join(map(repr, args))}")
            self.entities = list(given)
            RECORDING.descriptions.append(self)

    def __repr__(self) -> str:
        return f"{self.kind}(...)"

    def get(self, key: str, position: int = -1, default: object = None) -> Any:
        """Return an argument by name, or by position."""
        if key in self.kwargs:
            return self.kwargs[key]
        return self.args[position] if 0 <= position < len(self.args) else default

    def __getattr__(self, name: str) -> Any:
        """Return the argument given for a parameter; None if there is none."""
        if name in self.kwargs:
            return self.kwargs[name]
        known = PARAMETERS.get(self.kind, Parameters((), ()))
        if name not in known.names:
            raise AttributeError(f"{self.kind} has no {name!r} here: a launch file is read, and not run by launch")
        return self.get(name, known.by_place.index(name) if name in known.by_place else -1)

    def execute(self, context: object = None) -> list[object] | None:
        """Execute an action at once, from code of the launch file; overrides return the actions that they make."""
        RECORDING.carry_out(self)
        return [] if self.kind in ("GroupAction", "IncludeLaunchDescription") else None

    def visit(self, context: object = None) -> list[object] | None:
        """Execute an action under its condition, which is converted with it."""
        return self.execute(context)

    def describe(self) -> str:
        """Return the call as ROS's tools show it."""
        return f"{self.kind}({', '.join(map(text, self.args or self.kwargs.values()))})"

    def add_action(self, action: object) -> None:
        """Add an action to a launch description, perhaps while it is being executed."""
        if "entities" not in self.__dict__:
            raise AttributeError(f"{self.kind} has no add_action")
        self.entities.append(action)

    add_entity = add_action

    def find(self, package: object = None) -> str:
        """Return the folder of a package, as `FindPackageShare.find` does."""
        return RECORDING.folder("share", text(package))

    def perform(self, context: object = None) -> str:
        """Return the value of a substitution."""
        return RECORDING.known(_substitution(self))

    def evaluate(self, context: object = None) -> bool:
        """Return the value of a condition."""
        ((attribute, expression),) = condition(self).items()
        return truth(RECORDING.known(expression), RECORDING.file) is (attribute == "if")

    def __str__(self) -> str:
        return text(self)

    def __format__(self, spec: str) -> str:
        if BASES.get(self.kind) == "Substitution":
            RECORDING.remark(self, f"{self.kind} in an f-string is an object to ROS 2; write a list: ['text', ...]")
        return format(text(self), spec)

    def __add__(self, other: object) -> NoReturn:
        raise TypeError(_no_sum(self, self, other))

    def __radd__(self, other: object) -> NoReturn:
        raise TypeError(_no_sum(self, other, self))

    def __truediv__(self, other: object) -> Any:
        """Join paths, as substitutions that are paths do."""
        return stand_in_of("PathJoinSubstitution")([self, other])

    def __rtruediv__(self, other: object) -> Any:
        return stand_in_of("PathJoinSubstitution")([other, self])


def called_as(value: object) -> str:
    """Return a value as messages show it: a recorded call without its arguments."""
    return f"{value.kind}(...)" if isinstance(value, RecordedCall) else repr(value)


def parts(call: RecordedCall) -> list[object]:
    """Return the arguments of a call, and the actions added to a launch description."""
    # Not `call.entities`: OnStateTransition has an argument of that name.
    return [*call.args, *call.kwargs.values(), *call.__dict__.get("entities", ())]


def _no_sum(call: RecordedCall, *operands: object) -> str:
    """Return the error for `+` with a substitution, which ROS 2's classes do not have either."""
    shown = ", ".join(map(called_as, operands))
    return f"{call.kind} is not a text before the launch, and has no +; write a list: [{shown}]"


def text(value: object) -> str:
    """Convert a value to the text that it is in the YAML dialect, with substitutions as `$(...)`."""
    if isinstance(value, (list, tuple)):
        return "".join(map(text, value))
    if not isinstance(value, RecordedCall):
        return str(value)
    # A substitution class of the launch file itself.
    if type(value).perform is not RecordedCall.perform and RECORDING.values is not None:
        return text(value.perform(Context()))
    return _substitution(value)


def _substitution(call: RecordedCall) -> str:
    """Convert a substitution to text."""
    first = call.args[0] if call.args else next(iter(call.kwargs.values()), "")
    name, optional = _WITH_DEFAULT.get(call.kind, ("", ""))
    if name:
        rest = call.get(optional, -1 if call.kind == "Parameter" else 1)  # keyword-only there
        return f"$({name} {_word(first)}{'' if rest is None else f' {_word(rest)}'})"
    if call.kind in _OF_ALL_ARGUMENTS:
        words = [_word("" if one is None else one) for one in call.args]
        return f"$({' '.join([_OF_ALL_ARGUMENTS[call.kind], *words])})"
    if call.kind in _OF_ONE_ARGUMENT:
        return f"$({_OF_ONE_ARGUMENT[call.kind]} {_word(first)})"
    if call.kind in _WITHOUT_ARGUMENTS:
        return f"$({_WITHOUT_ARGUMENTS[call.kind]})"
    match call.kind:
        case "ExecutableInPackage":
            return f"$(exec-in-pkg {_word(call.get('executable', 0))} {_word(call.get('package', 1))})"
        case "PathJoinSubstitution":
            # As in launch: a part that begins with a slash drops those before it.
            return os.path.join("", *map(text, first if isinstance(first, (list, tuple)) else call.args))
        case "PythonExpression":
            expression = text(first)
            return f"$(eval {as_word(expression) if expression[:1] in QUOTES else expression})"
        case "IfElseSubstitution":
            values = (call.get("condition", 0), call.get("if_value", 1, ""), call.get("else_value", 2, ""))
            return f"$(if {' '.join(map(_word, values))})"
        case kind if kind in _PLAIN or kind.endswith("LaunchDescriptionSource"):
            return text(first)
    RECORDING.problem(call, no_equivalent(call))
    return ""


_PLAIN = ("TextSubstitution", "PathSubstitution", "ParameterValue", "ParameterFile")
"""Classes whose text is that of their first argument."""
_WITH_DEFAULT = {
    "LaunchConfiguration": ("var", "default"),
    "EnvironmentVariable": ("env", "default_value"),
    "Parameter": ("param", "default"),
    "Command": ("command", "on_stderr"),
}
"""Substitutions of one argument and an optional second, with its name."""
_OF_ONE_ARGUMENT = {
    "FindPackageShare": "find-pkg-share",
    "FindPackagePrefix": "find-pkg-prefix",
    "FileContent": "file-content",
    "FindExecutable": "find-exec",
    "AnonName": "anon",
    "NotSubstitution": "not",
}
_OF_ALL_ARGUMENTS = {
    "AnySubstitution": "any",
    "AllSubstitution": "all",
    "EqualsSubstitution": "equals",
    "NotEqualsSubstitution": "not-equals",
    "AndSubstitution": "and",
    "OrSubstitution": "or",
}
_WITHOUT_ARGUMENTS = {
    "ThisLaunchFileDir": "dirname",
    "ThisLaunchFile": "filename",
    "LaunchLogDir": "log_dir",
    "LogDir": "log_dir",
}


def _word(value: object) -> str:
    """Convert a value to a word of a substitution."""
    return as_word(text(value))


def condition(call: RecordedCall) -> dict[str, str]:
    """Convert a condition to the attribute `if` or `unless` of an action."""
    attributes = {"IfCondition": "if", "UnlessCondition": "unless"}
    if call.kind in attributes:
        return {attributes[call.kind]: text(call.args[0] if call.args else "")}
    if call.kind in ("LaunchConfigurationEquals", "LaunchConfigurationNotEquals"):
        # `...ConfigurationEquals` ends so, and `...NotEquals` does not.
        comparison = "equals" if call.kind.endswith("nEquals") else "not-equals"
        variable, value = call.args
        return {"if": f"$({comparison} $(var {_word(variable)}) {_word(value)})"}
    RECORDING.problem(call, no_equivalent(call))
    return {}


def no_equivalent(call: RecordedCall) -> str:
    """Return the problem of a class that a graph file cannot express, with the class that may be meant."""
    known = {name for names in NAMES.values() for name in names.split()}
    if call.kind in NAMES["launch.event_handlers"].split():
        return f"{call.kind} is an event handler, and no action: write RegisterEventHandler({call.kind}(...))"
    near = nearest(call.kind, known, cutoff=0.85) if call.kind not in known else None
    if call.kind == "DeclareLaunchArgument":
        name = call.args[0] if call.args and isinstance(call.args[0], str) else "NAME"
        way = f"LaunchConfiguration({name!r}) has its value, where one is used"
        return f"a DeclareLaunchArgument only declares the argument, in the list of a LaunchDescription; {way}"
    return f"{call.kind} has no equivalent in a graph file" + (f"; did you mean {near!r}?" if near else "")


def plain(value: object) -> Data:
    """Convert a value to JSON: numbers stay numbers, substitutions become texts."""
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (list, tuple)):
        is_text = any(isinstance(part, RecordedCall) for part in value) and all(
            isinstance(part, (RecordedCall, str)) for part in value
        )
        if not is_text:  # a list of values, in which a list of substitutions is a text again
            return [text(part) if isinstance(part, (list, tuple)) else plain(part) for part in value]
    return text(value)


OWN: dict[str, Any] = {
    "PackageNotFoundError": PackageNotFoundError,
    "SubstitutionFailure": SubstitutionError,
    "InvalidConditionExpressionError": SubstitutionError,
    "LaunchContext": Context,
}
"""Functions, and classes that do more than record, by name; the module that defines one adds it."""
_SUBMODULES = {"actions", "substitutions", "conditions", "events", "event_handlers", "launch_description_sources"}
_SUBMODULES |= {"descriptions", "parameter_descriptions", "packages", "lifecycle", "logging", "utilities"}
_SUBMODULES |= {"frontend", "some_substitutions_type", "type_utils"}


class _Module(ModuleType):
    """A module that makes its attributes on first access."""

    def __getattr__(self, name: str) -> Any:
        if name == "__all__" and self.__name__ in NAMES:
            return NAMES[self.__name__].split()
        if name.startswith("__"):
            raise AttributeError(name)
        attribute = _attribute(self.__name__, name)
        setattr(self, name, attribute)
        return attribute


def _attribute(module: str, name: str) -> Any:
    """Return the attribute of a module of ROS's launch packages."""
    if name in _SUBMODULES:  # `import launch` alone is enough for `launch.actions`, as in ROS 2
        return import_module(f"{module}.{name}")
    elsewhere = home(module, name)
    if elsewhere is not None:
        raise ImportError(f"{module} has no {name}; write: from {elsewhere} import {name}", name=module)
    if name in OWN:
        return OWN[name]
    # Classes are in CamelCase. `matches_action` is a function in launch, but its call must be recorded.
    return stand_in_of(name) if name[:1].isupper() or name.startswith("matches_") else _function(module, name)


@cache
def stand_in_of(name: str) -> Any:
    """Return the stand-in for a class."""
    if name.endswith(("Error", "Failure", "Exception")):  # a file may want to catch it
        return type(name, (Exception,), {})
    base = stand_in_of(BASES[name]) if name in BASES else RecordedCall
    return type(name, (base,), {"kind": name})


def stand_in(package: str) -> Callable[[str], Any]:
    """Return the `__getattr__` of a package for use outside of launch files, and make its modules importable."""
    if not any(isinstance(finder, StandIns) for finder in sys.meta_path):
        sys.meta_path.append(StandIns())

    def get(name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return _attribute(package, name)

    return get


def _function(module: str, name: str) -> Callable[..., object]:
    what = "prefix" if name.endswith("prefix") else "share"
    if name in ("get_package_share_directory", "get_package_prefix"):
        return lambda package, *_: RECORDING.folder(what, package)
    if name in ("get_package_share_path", "get_package_prefix_path"):
        return lambda package, *_: Path(RECORDING.folder(what, package))
    if name == "get_logger":
        return logging.getLogger

    def missing(*_: object, **__: object) -> NoReturn:
        raise NotImplementedError(
            f"{module}.{name} is not here: graphflow reads launch files without launch's own code"
        )

    return missing


class StandIns(MetaPathFinder, Loader):
    """Importer of the stand-ins for ROS's launch packages."""

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        return ModuleSpec(name, self, is_package=True) if name.partition(".")[0] in PACKAGES else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        return _Module(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing: attributes are made on first access."""
