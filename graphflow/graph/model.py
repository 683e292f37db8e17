"""The grammar of a graph file, as pydantic models. Unknown keys are errors."""

from __future__ import annotations

import re
from typing import Annotated, Any, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    StrictBool,
    StrictFloat,
    StrictInt,
    StrictStr,
    model_validator,
)

from graphflow.interface import DeadlockPolicy, WhenFull

_CLASS = re.compile(r"[A-Za-z_][\w.]*:[A-Za-z_]\w*\Z")


def _class_path(text: str) -> str:
    if not _CLASS.match(text):
        raise ValueError(f"{text!r} is not a class; write package.module:Class, for example nodes.talker:Talker")
    return text


def _service_type(text: str) -> str:
    if not re.match(r"[a-z]\w*(/srv)?/[A-Z]\w*\Z", text):
        raise ValueError(f"{text!r} is not a service type; write package/srv/Name")
    return text


def _graph_name(text: str) -> str:
    # The name becomes a folder.
    if not re.match(r"\w[\w.-]*\Z", text):
        raise ValueError(f"{text!r} is not a name for a graph; use letters, digits, _, - and .")
    return text


def _limit(value: Any) -> Any:
    if value != "none" and (not isinstance(value, int) or isinstance(value, bool) or value < 1):
        raise ValueError(f"limit: expected 1 or more, or none for no limit, got {value!r}")
    return value


def _when_full(value: str) -> str:
    if value not in get_args(WhenFull):
        raise ValueError(f"when_full: expected one of {', '.join(get_args(WhenFull))}, got {value!r}")
    return value


def _policy(value: str) -> str:
    if value not in get_args(DeadlockPolicy):
        raise ValueError(f"deadlock: expected one of {', '.join(get_args(DeadlockPolicy))}, got {value!r}")
    return value


def _call_timeout(value: Any) -> Any:
    if value != "never" and (not isinstance(value, (int, float)) or isinstance(value, bool) or not value > 0):
        raise ValueError(f"call_timeout: expected seconds, or never, got {value!r}")
    return value


Scalar = StrictBool | StrictInt | StrictFloat | StrictStr
ParamValue = Scalar | list[Scalar]
EnvValue = StrictStr | StrictInt | StrictFloat


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _drop_empty(cls, data: Any) -> Any:
        """A key with no value, perhaps because its lines are commented out, counts as absent."""
        if data is None:
            return {}
        if not isinstance(data, dict):
            return data
        optional = {f.alias or name for name, f in cls.model_fields.items() if not f.is_required()}
        return {k: v for k, v in data.items() if v is not None or k not in optional}


class Arg(_Model):
    """A value that `name:=value` on the command line sets."""

    default: Any = None
    doc: StrictStr = ""
    unit: StrictStr = ""
    choices: list[Scalar] = []


class GroupSpec(_Model):
    """One concurrency group of a node; written as a list of handlers when nothing else needs saying."""

    handlers: StrictStr | list[StrictStr] = []
    limit: Annotated[Any, AfterValidator(_limit)] = None
    thread: StrictBool | None = None
    when_full: Annotated[StrictStr, AfterValidator(_when_full)] | None = None

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, data: Any) -> Any:
        return {"handlers": data} if isinstance(data, (list, str)) else data


class NodeSpec(_Model):
    """One node of the graph. Its key is its name, absolute or relative to `namespace`."""

    class_: Annotated[StrictStr, AfterValidator(_class_path)] = Field(alias="class")
    namespace: StrictStr = ""
    params: dict[str, Any] = {}
    params_file: StrictStr | list[StrictStr] = []
    remap: dict[str, StrictStr] = {}
    process: StrictStr = ""
    env: dict[str, EnvValue] = {}
    after: StrictStr | list[StrictStr] = []
    concurrency: dict[str, GroupSpec] = {}


class StepSpec(_Model):
    """Something done once, after nodes and other steps: a service call."""

    call: StrictStr
    type: Annotated[StrictStr, AfterValidator(_service_type)] | None = None
    request: dict[str, Any] = {}
    after: StrictStr | list[StrictStr] = []
    timeout: StrictFloat | StrictInt = Field(10.0, gt=0)


class GraphFile(_Model):
    """A whole file."""

    name: Annotated[StrictStr, AfterValidator(_graph_name)] | None = None
    domain: StrictInt | None = Field(None, ge=0)
    args: dict[str, Arg] = {}
    nodes: dict[str, NodeSpec]
    steps: dict[str, StepSpec] = {}
    include: StrictStr | None = None
    override: dict[str, Any] = {}
    deadlock: Annotated[StrictStr, AfterValidator(_policy)] = "raise"
    call_timeout: Annotated[Any, AfterValidator(_call_timeout)] = None
    console: Any = None
    """Read by `graph.console`."""


TOP_KEYS = tuple(GraphFile.model_fields)


def keys_of(model: type[BaseModel]) -> list[str]:
    """The keys a model knows, as written in a file."""
    return [f.alias or name for name, f in model.model_fields.items()]
