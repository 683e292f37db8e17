"""The declarations of a node class as frozen data, known without creating a node, and convertible to JSON.

Checks, plans and listings use them; they refer to no class or function object.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from fnmatch import fnmatchcase
from pathlib import PurePath
from typing import Any, Literal

from graphflow.errors import ParameterError, Place
from graphflow.typographic import plain

EndpointKind = Literal["publisher", "subscription", "service", "client", "action", "action client"]
ParamType = Literal["bool", "int", "float", "str", "list[bool]", "list[int]", "list[float]", "list[str]", "bytes"]

TYPE_IDS: dict[ParamType, int] = {
    "bool": 1,
    "int": 2,
    "float": 3,
    "str": 4,
    "bytes": 5,
    "list[bool]": 6,
    "list[int]": 7,
    "list[float]": 8,
    "list[str]": 9,
}
"""The constants of rcl_interfaces/msg/ParameterType."""
TYPE_NAMES = {0: "not set", 1: "boolean", 2: "integer", 3: "double", 4: "string", 5: "byte array"} | {
    6: "boolean array",
    7: "integer array",
    8: "double array",
    9: "string array",
}
"""ROS 2's names of the types."""
_TRUTHS = {**dict.fromkeys(("yes", "on", "y"), "true"), **dict.fromkeys(("no", "off", "n"), "false")}
"""Words for flags in YAML 1.1, which ROS 2 reads, and what to write for them."""
_INT64 = range(-(2**63), 2**63)


@dataclass(frozen=True, slots=True)
class EndpointInfo:
    """A topic, service or action that a class uses under `name`."""

    kind: EndpointKind
    name: str
    type: str
    attribute: str
    place: Place
    group: str = ""
    """The group of a client's responses; empty for none."""
    is_made: bool = False
    """Whether a method creates it, perhaps only in some cases."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter with its type, default and limits (inclusive, except that `gt` and `lt` are strict)."""

    name: str
    type: ParamType
    default: Any
    place: Place
    unit: str = ""
    doc: str = ""
    ge: float | None = None
    le: float | None = None
    gt: float | None = None
    lt: float | None = None
    read_only: bool = False
    step: float = 0.0
    """Distance between allowed values, from `ge` or 0; 0 allows all values. The limits are always allowed."""
    choices: tuple[Any, ...] = ()
    """The allowed values, of each element for a list; empty for any."""
    dynamic: bool = False
    """Whether the parameter takes values of any type and may be deleted (ROS 2's dynamic typing)."""

    def fit(self, value: Any) -> Any:
        """Return a value as the declared type; integers are widened to floats.

        Raises:
            ParameterError: The value is of another type or out of range; the text names the allowed ones.
        """
        if self.dynamic:
            return None if value is None else self._any(value)
        if self.type.startswith("list[") and isinstance(value, (list, tuple)):
            element: ParamType = self.type[5:-1]  # type: ignore[assignment]
            return [self._scalar(element, item) for item in value]
        return self._scalar(self.type, value)

    @staticmethod
    def _any(value: Any) -> Any:
        type_of(value)
        return list(value) if isinstance(value, tuple) else value

    def _correction(self, value: object) -> str:
        """Return what to write in place of a value of another type; "" if it is not known."""
        match value:
            case str() if self.type == "bool" and value.lower() in _TRUTHS:
                return f"write {_TRUTHS[value.lower()]}: {value} is a text in YAML 1.2"
            case int() | float() if self.type == "str":
                text = f"'{str(value).lower() if isinstance(value, bool) else value}'"
                return f'write {text}, with the quotes; in a shell "{text}"'
            case str() if plain(value) != value:
                return f"write {plain(value)}"
            case float() if self.type == "int" and value.is_integer():
                return f"write {int(value)}"
            case float() if self.type == "int" and self._is_installed:
                return f"write an integer, such as {math.floor(value)}"
            case float() if self.type == "int" and isinstance(self.default, int):
                where = f" in {self.place}" if self.place.file else ""
                return f"its default is {self.default}, an integer: for a double, write {self.default}.0{where}"
        return ""

    @property
    def _is_installed(self) -> bool:
        """Whether the parameter is declared in an installed package, whose source is not for editing."""
        return not {"site-packages", "dist-packages"}.isdisjoint(PurePath(self.place.file).parts)

    def _scalar(self, type_: ParamType, value: Any) -> Any:
        if type_ == "float" and isinstance(value, int) and not isinstance(value, bool):
            try:
                value = float(value)
            except OverflowError:
                raise ParameterError(
                    f"parameter {self.name!r} = {str(value)[:20]}... is too large for a double"
                ) from None
        if type_ == "bytes" and isinstance(value, bytearray):
            value = bytes(value)
        try:
            fits = type_of(value) == type_ and (type_ != "int" or value in _INT64)
        except ParameterError:
            fits = False
        if not fits:
            word = TYPE_NAMES[TYPE_IDS[self.type]]
            way = self._correction(value)
            hint = f"; {way}" if way else ""
            raise ParameterError(f"parameter {self.name!r} is of type {word}, {value!r} is not{hint}")
        if type_ in ("int", "float"):
            self._check_range(value)
        if self.choices and value not in self.choices:
            raise ParameterError(f"parameter {self.name!r} = {value!r} is not {self.choices_text()}")
        return value

    def choices_text(self) -> str:
        """Return the choices as text: `one of 'fast', 'slow'`; empty if there are none."""
        return f"one of {', '.join(map(repr, self.choices))}" if self.choices else ""

    def _check_range(self, number: float) -> None:
        inside = (
            (self.ge is None or number >= self.ge)
            and (self.le is None or number <= self.le)
            and (self.gt is None or number > self.gt)
            and (self.lt is None or number < self.lt)
        )
        if not inside:
            unit = f" {self.unit}" if self.unit else ""
            raise ParameterError(f"parameter {self.name!r} = {number} is out of range: {self.range_text()}{unit}")
        if self.step and number not in (self.ge, self.le) and math.isfinite(number):
            start = self.ge or 0
            nearest = start + round((number - start) / self.step) * self.step
            # As in rclpy: integers exactly, floats within a millionth.
            fits = (
                nearest == number if self.type in ("int", "list[int]") else math.isclose(nearest, number, rel_tol=1e-6)
            )
            if not fits:
                raise ParameterError(
                    f"parameter {self.name!r} = {number} is not a valid step: {start:g} plus a multiple of "
                    f"{self.step:g}, such as {nearest:g}"
                )

    def range_text(self) -> str:
        """Return the range as text: `0 to 255`, `more than 0`; empty if there is none."""
        if self.ge is not None and self.le is not None:
            return f"{self.ge:g} to {self.le:g}"
        words = {"ge": "at least", "gt": "more than", "le": "at most", "lt": "less than"}
        limits = [(word, getattr(self, key)) for key, word in words.items()]
        return " and ".join(f"{word} {limit:g}" for word, limit in limits if limit is not None)


_NOWHERE = Place("graphflow")
COMMON_PARAMETERS: dict[str, Parameter] = {
    p.name: p
    for p in (
        Parameter("use_sim_time", "bool", False, _NOWHERE, doc="Use the time published on /clock."),
        Parameter(
            "start_type_description_service", "bool", True, _NOWHERE, doc="Serve type descriptions.", read_only=True
        ),
    )
}
"""The parameters of every node, as in ROS 2."""
COMMON_SERVICES: dict[str, str] = {
    "get_parameters": "rcl_interfaces/srv/GetParameters",
    "get_parameter_types": "rcl_interfaces/srv/GetParameterTypes",
    "set_parameters": "rcl_interfaces/srv/SetParameters",
    "set_parameters_atomically": "rcl_interfaces/srv/SetParametersAtomically",
    "list_parameters": "rcl_interfaces/srv/ListParameters",
    "describe_parameters": "rcl_interfaces/srv/DescribeParameters",
    "get_type_description": "type_description_interfaces/srv/GetTypeDescription",
    "get_logger_levels": "rcl_interfaces/srv/GetLoggerLevels",
    "set_logger_levels": "rcl_interfaces/srv/SetLoggerLevels",
}
"""The services of every node that is not created without them: types by name, relative to the node's."""
LIFECYCLE_SERVICES: dict[str, str] = {
    "change_state": "lifecycle_msgs/srv/ChangeState",
    "get_state": "lifecycle_msgs/srv/GetState",
    "get_available_states": "lifecycle_msgs/srv/GetAvailableStates",
    "get_available_transitions": "lifecycle_msgs/srv/GetAvailableTransitions",
    "get_transition_graph": "lifecycle_msgs/srv/GetAvailableTransitions",
}
"""The additional services of every lifecycle node."""


WhenFull = Literal["wait", "drop_new", "drop_old", "cancel_running"]
"""The policy for work that finds no free slot in its group.

`wait`: it queues. `drop_new`: it is dropped. `drop_old`: it queues, and work queued before it is dropped.
`cancel_running`: as `drop_old`, and the oldest active run is cancelled.
"""

DeadlockPolicy = Literal["raise", "report", "break", "off"]
"""The policy for deadlocks.

`raise`: a call that cannot succeed fails at once, and any other deadlock is reported. `report`: all are reported.
`break`: as `raise`, and the youngest call of a deadlock ends with DeadlockError. `off`: deadlocks are not detected.
"""
GoalPolicy = Literal["reject", "queue", "preempt", "parallel"]
"""The policy for a goal that arrives while another is active.

`reject`: it is not accepted. `queue`: it waits for its turn. `preempt`: the active goal is aborted, and the new one
begins when that has ended. `parallel`: they run concurrently, as far as their group allows.
"""
OnClientLoss = Literal["continue", "cancel"]
"""The policy for a goal whose client has disappeared."""

OnError = Literal["budget", "log", "end"]
"""The policy for an error in a timer or subscription.

`budget`: it is logged and counted, and too many end the node. `log`: it is logged. `end`: it ends the node.
"""

CALL_TIMEOUT = 10.0
"""Default timeout of a call in seconds."""
NO_GROUP = "none"
"""The key in a graph file for handlers that are to be in no group."""


@dataclass(frozen=True, slots=True)
class GroupInfo:
    """A concurrency group as a class declares it."""

    limit: int | None = 1
    """Maximum of concurrent runs; None for no limit."""
    when_full: WhenFull = "wait"
    thread: bool = False


@dataclass(frozen=True, slots=True)
class GroupChange:
    """A graph file's change of a node's group: its members, and settings that differ from the declaration."""

    handlers: tuple[str, ...] = ()
    limit: int | None = 1
    sets_limit: bool = False
    when_full: WhenFull | None = None
    thread: bool | None = None

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> GroupChange:
        return cls(**{**data, "handlers": tuple(data["handlers"])})


HandlerKind = Literal["subscription", "timer", "service", "action", "task"]


@dataclass(frozen=True, slots=True)
class HandlerInfo:
    """A method that is called for a timer, a message, a request or a goal, or runs as a task."""

    name: str
    kind: HandlerKind
    place: Place
    group: str = ""
    """The name of its group; empty for a handler that waits only for its own runs."""
    is_async: bool = True
    thread: bool = False


@dataclass(frozen=True, slots=True)
class Interface:
    """All declarations of a node class, including those of its base classes."""

    class_path: str
    """`package.module:Class`."""
    node_name: str
    """The default name of its nodes."""
    place: Place
    doc: str = ""
    endpoints: tuple[EndpointInfo, ...] = ()
    params: tuple[Parameter, ...] = ()
    handlers: tuple[HandlerInfo, ...] = ()
    groups: dict[str, GroupInfo] = field(default_factory=dict)
    dynamic_names: bool | tuple[str, ...] = False
    """Names of endpoints created at run time: True for any, else patterns such as `*/cmd_vel`."""
    unread: tuple[Place, ...] = ()
    """Places where endpoints are created whose names the source does not show."""
    made_params: tuple[str, ...] = ()
    """Patterns of the names of parameters that are made at run time, such as `*.radius` of `f"{wheel}.radius"`."""
    is_managed: bool = False
    """Whether it is a `LifecycleNode`."""
    attributes: tuple[str, ...] = ()
    """Attributes that the class declares, of any kind."""

    def param(self, name: str) -> Parameter | None:
        """Find a parameter of the class, or of every node, by name."""
        return next((p for p in self.params if p.name == name), COMMON_PARAMETERS.get(name))

    def may_have(self, param: str) -> bool:
        """Return whether a node of the class has a parameter, or may make it at run time."""
        return self.param(param) is not None or any(fnmatchcase(param, pattern) for pattern in self.made_params)

    def to_json(self) -> dict[str, Any]:
        """Return the interface as JSON, which `from_json` reads."""
        data = asdict(self)
        for param in data["params"]:
            if isinstance(param["default"], bytes):
                param["default"] = param["default"].decode("latin-1")
                param["choices"] = [choice.decode("latin-1") for choice in param["choices"]]
        return data

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Interface:
        dynamic = data["dynamic_names"]
        return cls(
            **{k: v for k, v in data.items() if k in ("class_path", "node_name", "doc", "is_managed")},
            place=Place(*data["place"]),
            endpoints=tuple(EndpointInfo(**{**e, "place": Place(*e["place"])}) for e in data["endpoints"]),
            params=tuple(_parameter(p) for p in data["params"]),
            handlers=tuple(HandlerInfo(**{**h, "place": Place(*h["place"])}) for h in data["handlers"]),
            groups={name: GroupInfo(**group) for name, group in data["groups"].items()},
            dynamic_names=dynamic if isinstance(dynamic, bool) else tuple(dynamic),
            unread=tuple(Place(*place) for place in data["unread"]),
            made_params=tuple(data["made_params"]),
            attributes=tuple(data["attributes"]),
        )


def _parameter(data: dict[str, Any]) -> Parameter:
    default, choices = data["default"], data["choices"]
    if data["type"] == "bytes":
        default, choices = default.encode("latin-1"), [choice.encode("latin-1") for choice in choices]
    return Parameter(**{**data, "default": default, "choices": tuple(choices), "place": Place(*data["place"])})


def type_of(value: Any) -> ParamType:
    """Return the parameter type of a Python value.

    Raises:
        ParameterError: No parameter can have the value.
    """
    if isinstance(value, bool):
        return "bool"
    for cls, name in ((int, "int"), (float, "float"), (str, "str"), (bytes, "bytes")):
        if isinstance(value, cls):
            return name  # type: ignore[return-value]
    if isinstance(value, (list, tuple)):
        kinds = {type_of(item) for item in value}
        if kinds == {"int", "float"}:
            kinds = {"float"}
        if len(kinds) == 1 and (kind := kinds.pop()) in ("bool", "int", "float", "str"):
            return f"list[{kind}]"  # type: ignore[return-value]
    way = "use a bool, int, float, str, bytes, or a list of one of them"
    if isinstance(value, type) and value in (bool, int, float, str, bytes):
        way = f"its default decides the type: write {value()!r}"
    if isinstance(value, dict) and value:
        way = f"it is a mapping, whose keys are parameters of their own, as in NAME.{next(iter(value))}"
    raise ParameterError(f"{value!r} cannot be a parameter: {way}")


def type_id(value: Any) -> int:
    """Return the number of a value's type in rcl_interfaces/msg/ParameterType; 0 (not set) for None."""
    return 0 if value is None else TYPE_IDS[type_of(value)]


def may_make(dynamic_names: bool | Sequence[str], full_name: str) -> bool:
    """Return whether a class with some `dynamic_names` may create an endpoint `full_name` at run time."""
    if isinstance(dynamic_names, bool):
        return dynamic_names
    return any(fnmatchcase(full_name, pattern) for pattern in dynamic_names)
