"""The grammar of a graph file, as pydantic models. Unknown keys are errors."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StrictBool,
    StrictFloat,
    StrictInt,
    StrictStr,
    WithJsonSchema,
    model_validator,
)

from graphflow.domain import DOMAIN_VARIABLES
from graphflow.interface import DeadlockPolicy, WhenFull
from graphflow.machines.restarts import BACKOFF, POLICIES
from graphflow.names import nearest
from graphflow.reading import found_text
from graphflow.times import seconds_in

FROM_GROUPS = " of groups"
"""Suffix of the keys for what a node has from its groups; no file can contain them."""

NO_CLASS = "-"
"""Placeholder for the class of a foreign program, which has none."""
_CLASS = re.compile(r"[A-Za-z_][\w.]*:[A-Za-z_]\w*\Z")


def _class_path(text: str) -> str:
    if text != NO_CLASS and not _CLASS.match(text):
        raise ValueError(f"{text!r} is not a class; {class_meant(text)}")
    return text


def class_meant(text: str) -> str:
    """Return the correction of an invalid class path: of a file, of dots only, of a module with a hyphen."""
    path, colon, name = text.partition(":")
    module = re.sub(r"\.py$", "", path.strip()).replace("/", ".").strip(".")
    if "-" in module and _CLASS.match(f"{module.replace('-', '_')}:{name.strip() or 'A'}"):
        *_, file = (part for part in module.split(".") if "-" in part)
        return f"Python imports no name with a hyphen; rename {file} to {file.replace('-', '_')}"
    dotted, _, last = module.rpartition(".")
    if not colon and last[:1].isupper() and _CLASS.match(f"{dotted}:{last}"):
        return f"write {_module_with(last, dotted)}:{last}"
    if not name.strip() and module != text.strip() and _CLASS.match(f"{module}:A"):
        return f"write the class in it, too: {module}:CLASS"
    if _CLASS.match(f"{module}:{name.strip()}"):
        return f"write {module}:{name.strip()}"
    return "write package.module:Class, for example nodes.talker:Talker"


def _module_with(name: str, package: str) -> str:
    """Return the module of a package that has a class; the package itself if none is found in the working directory."""
    for file in sorted(Path(package.replace(".", "/")).glob("*.py")):
        with suppress(OSError):
            if re.search(rf"^class {name}\b", found_text(file, "replace"), re.MULTILINE):
                return package if file.stem == "__init__" else f"{package}.{file.stem}"
    return package


def _interface_type(text: str) -> str:
    if not re.match(r"[a-z]\w*(/(srv|action))?/[A-Z]\w*\Z", text):
        raise ValueError(f"{text!r} is not a service type; write package/srv/Name, or package/action/Name for a goal")
    return text


def _graph_name(text: str) -> str:
    # A run has a folder of this name.
    if not re.match(r"\w[\w.-]*\Z", text):
        raise ValueError(f"{text!r} is not a name for a graph; use letters, digits, _, - and .")
    return text


def _command(words: list[object]) -> list[object]:
    if not words:
        raise ValueError("command: is empty; write the program and its words: command: [rviz2, -d, robot.rviz]")
    return words


def _limit(value: object) -> object:
    if value != "none" and (not isinstance(value, int) or isinstance(value, bool) or value < 1):
        raise ValueError(f"limit: expected 1 or more, or none for no limit, got {value!r}")
    return value


def _call_timeout(value: object) -> object:
    if value != "never" and (not isinstance(value, (int, float)) or isinstance(value, bool) or not value > 0):
        way = f"; write call_timeout: {number}" if isinstance(value, str) and (number := seconds_in(value)) else ""
        raise ValueError(f"call_timeout: expected seconds, or never, got {value!r}{way}")
    return value


_EQUIVALENTS = {
    "restart: no": "never",
    "restart: false": "never",
    "restart: yes": "always",
    "restart: true": "always",
    "restart: unless-stopped": "always",
    "lifecycle: true": "active",
    "lifecycle: yes": "active",
    "log_level: warning": "warn",
    "log_level: critical": "fatal",
    "type: string": "str",
    "type: integer": "int",
    "type: double": "float",
    "type: boolean": "bool",
}
"""Values of other tools, with those of graph files."""


def _one_of(key: str, words: Sequence[str]) -> Callable[[object], object]:
    def checked(value: object) -> object:
        if value not in words:
            word = value if isinstance(value, str) else str(value).lower()  # as YAML writes true and false
            meant = _EQUIVALENTS.get(f"{key}: {word}") or nearest(word.lower().replace("-", "_"), words, cutoff=0.8)
            way = f"; write {key}: {meant}" if meant in words else ""
            got = repr(value) if isinstance(value, str) else word
            raise ValueError(f"{key}: expected one of {', '.join(words)}, got {got}{way}")
        return value

    return checked


def _enum(words: Iterable[str]) -> WithJsonSchema:
    """Return the schema of one of some texts, or of a text with a substitution that becomes one."""
    return WithJsonSchema({"anyOf": [{"enum": list(words)}, {"type": "string", "pattern": r"\$\("}]})


_OF_COMPOSE = {"service_started": "ready", "service_healthy": "ready", "service_completed_successfully": "done"}
"""The conditions of docker-compose, with those of `after:`."""


def _compose_condition(value: object) -> str:
    """Return a condition of `after:`, perhaps from one of docker-compose; empty for any other value."""
    word = value.get("condition") if isinstance(value, dict) else value
    return _OF_COMPOSE.get(word, word if word in AFTER else "") if isinstance(word, str) else ""


def _after(value: object) -> object:
    """Convert `after:` to a mapping from names to conditions; a name alone has the default condition, empty here."""
    if isinstance(value, str):
        return {value: ""}
    if isinstance(value, list) and all(isinstance(name, str) for name in value):
        return dict.fromkeys(value, "")
    if not isinstance(value, dict) or not all(word in (*AFTER, "") for word in value.values()):
        way = f"expected a name, a list of names, or NAME: {'|'.join(AFTER)}, got {value!r}"
        if (
            isinstance(value, dict)
            and (meant := [_compose_condition(wanted) for wanted in value.values()])
            and all(meant)
        ):
            pairs = ", ".join(f"{name}: {word}" for name, word in zip(value, meant, strict=True))
            way = f"write after: {{{pairs}}}"
        raise ValueError(f"after: {way}")
    return value


Scalar = StrictBool | StrictInt | StrictFloat | StrictStr
EnvValue = StrictStr | StrictInt | StrictFloat
Condition = object
"""True, false, or a text that becomes one of them by substitution."""

ARG_TYPES: Mapping[str, tuple[tuple[type, ...], str]] = {
    "bool": ((bool,), "true or false"),
    "int": ((int,), "a whole number"),
    "float": ((int, float), "a number"),
    "str": ((str,), "text"),
    "list": ((list,), "a list"),
}
"""The values of an argument's `type:`, with Python's types and their names in messages."""
AFTER = ("ready", "exited", "done")
"""The conditions of `after:`: a node is ready, has exited in any way, or has exited successfully."""
ON_EXIT = ("ignore", "restart", "shutdown")
STRATEGIES = ("one_for_one", "rest_for_one", "one_for_all")
LIFECYCLE = ("unconfigured", "inactive", "active")
"""The states that a lifecycle node can be brought to when it starts."""
LOG_LEVELS = ("debug", "info", "warn", "error", "fatal")
After = Annotated[Any, AfterValidator(_after)]


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _drop_empty(cls, data: object) -> object:
        """Drop keys without a value, perhaps because the lines below them are commented out."""
        if data is None:
            return {}
        if not isinstance(data, dict):
            return data
        optional = {f.alias or name for name, f in cls.model_fields.items() if not f.is_required()}
        return {k: v for k, v in data.items() if v is not None or k not in optional}


class Arg(_Model):
    """An argument, set by `name:=value` on the command line."""

    default: object = None
    doc: StrictStr = ""
    unit: StrictStr = ""
    type: Annotated[str, BeforeValidator(_one_of("type", tuple(ARG_TYPES))), _enum(ARG_TYPES)] | None = None
    choices: list[Scalar] = []


class GroupSpec(_Model):
    """A concurrency group of a node; a list of handlers for short."""

    handlers: StrictStr | list[StrictStr] = []
    limit: Annotated[Any, AfterValidator(_limit)] = None
    thread: StrictBool | None = None
    when_full: (
        Annotated[str, BeforeValidator(_one_of("when_full", get_args(WhenFull))), _enum(get_args(WhenFull))] | None
    ) = None

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, data: object) -> object:
        return {"handlers": data} if isinstance(data, (list, str)) else data


class RestartSpec(_Model):
    """The restart policy of a node; one word for short."""

    policy: Annotated[str, BeforeValidator(_one_of("restart", POLICIES)), _enum(POLICIES)] = "on_failure"
    delay: StrictFloat | StrictInt = Field(BACKOFF.delay, gt=0)
    max_delay: StrictFloat | StrictInt = Field(BACKOFF.max_delay, gt=0)
    max_restarts: StrictInt = Field(BACKOFF.max_restarts, ge=1)
    within: StrictFloat | StrictInt = Field(BACKOFF.within, gt=0)

    @model_validator(mode="before")
    @classmethod
    def _from_word(cls, data: object) -> object:
        if isinstance(data, bool):
            raise ValueError(f"restart: expected a word; write restart: {'always' if data else 'never'}")
        return {"policy": data} if isinstance(data, str) else data


class _Settings(_Model):
    """The settings of a node, or of a group for all its nodes."""

    namespace: StrictStr = ""
    params: dict[str, object] = {}
    params_file: StrictStr | list[StrictStr] = []
    remap: dict[str, StrictStr] = {}
    env: dict[str, EnvValue] = {}
    restart: RestartSpec | None = None
    on_exit: Annotated[str, BeforeValidator(_one_of("on_exit", ON_EXIT)), _enum(ON_EXIT)] | None = None
    critical: StrictBool | None = None
    log_level: Annotated[str, BeforeValidator(_one_of("log_level", LOG_LEVELS)), _enum(LOG_LEVELS)] | None = None
    lifecycle: Annotated[str, BeforeValidator(_one_of("lifecycle", LIFECYCLE)), _enum(LIFECYCLE)] | None = None
    if_: Condition = Field(None, alias="if")
    unless: Condition = None


OF_CLASSES = ("class", "concurrency", "process")
"""Keys that need a class."""
OF_PACKAGES = ("pkg", "exec", "args", "keep_names", "prefix")
"""Keys that need an executable of a package."""
OF_NODES = (*OF_CLASSES, *OF_PACKAGES, "lifecycle", "params", "params_file", "remap", "log_level")
"""Keys that a foreign program cannot have."""
_HELP = {
    "class": "write class: or command:, not both",
    "pkg": "write pkg: and exec:, or command:, not both",
    "args": "they stand in the list: command: [PROGRAM, WORD, WORD]",
    "prefix": "it stands in the list: command: [nice, -n, 5, PROGRAM]",
    "concurrency": "its code has its callback groups",
    "params": "pass it words: command: [PROGRAM, --ros-args, -p, NAME:=VALUE]",
    "remap": "pass it words: command: [PROGRAM, --ros-args, -r, FROM:=TO]",
}


class NodeSpec(_Settings):
    """One node of the graph, or a foreign program. Its key is its name, absolute or relative to `namespace`."""

    class_: Annotated[StrictStr, AfterValidator(_class_path)] = Field(alias="class")
    command: Annotated[list[StrictStr | StrictInt | StrictFloat], AfterValidator(_command)] = []
    pkg: StrictStr = ""
    exec_: StrictStr = Field("", alias="exec")
    args: list[StrictStr | StrictInt | StrictFloat] = []
    keep_names: StrictBool = False
    prefix: StrictStr = ""
    template: StrictStr = ""
    process: StrictStr = ""
    after: After = {}
    concurrency: dict[str, GroupSpec] = {}
    shared_params: dict[str, object] = Field({}, alias="params of groups")
    shared_params_file: list[StrictStr] = Field([], alias="params_file of groups")
    shared_remap: dict[str, StrictStr] = Field({}, alias="remap of groups")

    @model_validator(mode="before")
    @classmethod
    def _program(cls, data: object) -> object:
        """Validate the keys that depend on whether a node is a class, an executable of a package, or a program."""
        if not isinstance(data, dict):
            return data
        has = {key for key in data if data[key] is not None}
        if has & {"package", "executable"}:  # unknown keys, for which others may be missing
            return {"class": NO_CLASS, **data}
        if "command" in has:
            _refuse(OF_NODES, has)
            data = {k: v for k, v in data.items() if not k.endswith(FROM_GROUPS)}
        elif has & {"pkg", "exec"}:
            _check_executable(data, has)
            _refuse(OF_CLASSES, has)
        else:
            _check_class(data, has)
            return data
        return {**data, "class": NO_CLASS}


def _refuse(keys: Iterable[str], has: Collection[str]) -> None:
    wrong = next((key for key in keys if key in has), None)
    if wrong is not None:
        raise ValueError(f"{wrong}: is for nodes, and this is a program; {_HELP.get(wrong, 'remove it')}")


def _check_executable(data: Mapping[str, object], has: Collection[str]) -> None:
    is_file = "/" in str(data.get("exec")) or str(data.get("exec")).endswith(".py")
    if data.get("exec") in (None, "") or ("pkg" not in has and not is_file):
        raise ValueError("an executable has both: pkg: PACKAGE and exec: NAME; or exec: is a file")
    if "class" in has:
        raise ValueError("write class:, or pkg: and exec:, not both")
    if data.get("keep_names") and "lifecycle" in has:
        raise ValueError("lifecycle: needs the node's name, which keep_names leaves to the program")


def _check_class(data: Mapping[str, object], has: Collection[str]) -> None:
    env = data.get("env")
    domain = next((name for name in DOMAIN_VARIABLES if isinstance(env, dict) and name in env), None)
    if domain is not None and isinstance(env, dict):
        raise ValueError(f"env: {domain} has no effect on a node of the graph; write domain: {env[domain]} at the top")
    wrong = min((key for key in ("args", "keep_names") if key in has), default=None)
    if wrong is not None:
        which = f"the class {data['class']}" if isinstance(data.get("class"), str) else "a node with a class"
        raise ValueError(f"{wrong}: is for programs, and this is {which}, which takes params: and remap:; remove it")


class StepSpec(_Model):
    """A step, done once: a call, parameters, a goal, a wait, a delay, a log message, or a shutdown."""

    call: StrictStr = ""
    set_: StrictStr = Field("", alias="set")
    goal: StrictStr = ""
    wait: StrictStr = ""
    delay: StrictFloat | StrictInt | None = Field(None, gt=0)
    log: StrictStr = ""
    shutdown: StrictStr = ""
    type: Annotated[StrictStr, AfterValidator(_interface_type)] | None = None
    request: dict[str, object] = {}
    params: dict[str, object] = {}
    after: After = {}
    timeout: StrictFloat | StrictInt = Field(10.0, gt=0)
    if_: Condition = Field(None, alias="if")
    unless: Condition = None


class GroupBlock(_Settings):
    """Nodes and steps that share a namespace and settings."""

    after: After = {}
    nodes: dict[str, object] = {}
    steps: dict[str, object] = {}
    group: object = None
    for_: object = Field(None, alias="for")
    include: object = None


class ForBlock(GroupBlock):
    """A group that is repeated for each of several values."""

    var: StrictStr
    in_: object = Field(alias="in")


class IncludeBlock(_Model):
    """An included graph file; its name for short."""

    file: StrictStr
    args: dict[str, object] = {}
    override: dict[str, object] = {}
    namespace: StrictStr = ""
    if_: Condition = Field(None, alias="if")
    unless: Condition = None

    @model_validator(mode="before")
    @classmethod
    def _from_name(cls, data: object) -> object:
        return {"file": data} if isinstance(data, str) else data


class Net(_Model):
    """Permissions of others on the network."""

    allow_control: StrictBool = False


class GraphFile(_Model):
    """A graph file."""

    name: Annotated[StrictStr, AfterValidator(_graph_name)] | None = None
    domain: StrictInt | None = Field(None, ge=0)
    net: Net = Net()
    args: dict[str, Arg] = {}
    nodes: dict[str, NodeSpec] = {}
    steps: dict[str, StepSpec] = {}
    group: GroupBlock | list[GroupBlock] = []
    for_: ForBlock | list[ForBlock] = Field([], alias="for")
    templates: dict[str, object] = {}
    include: IncludeBlock | list[IncludeBlock] = []
    override: dict[str, object] = {}
    deadlock: Annotated[
        str, BeforeValidator(_one_of("deadlock", get_args(DeadlockPolicy))), _enum(get_args(DeadlockPolicy))
    ] = "raise"
    call_timeout: Annotated[Any, AfterValidator(_call_timeout)] = None
    strategy: Annotated[str, BeforeValidator(_one_of("strategy", STRATEGIES)), _enum(STRATEGIES)] = "one_for_one"
    console: object = None
    """Read by `console.section`."""


def keys_of(model: type[BaseModel]) -> list[str]:
    """Return the keys of a model, as files have them."""
    keys = [f.alias or name for name, f in model.model_fields.items()]
    return [key for key in keys if not key.endswith(FROM_GROUPS)]


TOP_KEYS = tuple(keys_of(GraphFile))
BLOCKS = ("nodes", "steps", "group", "for", "include")
"""Keys of a file, group or loop that contain nodes and steps."""
