"""YAML files as pydantic models, with each mistake at its line."""

from __future__ import annotations

from types import UnionType
from typing import Any, NotRequired, TypedDict, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from graphflow.errors import GraphFileError, Problem
from graphflow.markup.source import Source
from graphflow.names import did_you_mean

M = TypeVar("M", bound=BaseModel)


class Fault(TypedDict):
    """A fault that pydantic finds; the part of its `ErrorDetails` that is used here."""

    type: str
    loc: tuple[int | str, ...]
    msg: str
    input: object
    ctx: NotRequired[dict[str, Any]]


def validated(src: Source, kind: type[M]) -> M:
    """Convert a document to a model.

    Raises:
        GraphFileError: It has mistakes; all of them, with their places.
    """
    try:
        return kind.model_validate({} if src.data is None else src.data)
    except ValidationError as error:
        raise GraphFileError([_problem(src, fault, kind) for fault in error.errors()]) from None


def _problem(src: Source, fault: Fault, kind: type[BaseModel]) -> Problem:
    path = tuple(fault["loc"])
    if fault["type"] == "extra_forbidden":
        known = [field.alias or name for name, field in _model_at(kind, path[:-1]).model_fields.items()]
        return Problem(src.key_place(path), f"unknown key {path[-1]!r}{did_you_mean(str(path[-1]), sorted(known))}")
    if fault["type"] == "missing":
        return Problem(src.place(path[:-1]), f"the key {path[-1]!r} is missing")
    if fault["type"] == "value_error" and "ctx" in fault:
        return Problem(src.place(path), str(fault["ctx"]["error"]))
    return Problem(src.place(path), f"{fault['input']!r}: {_reason(fault)}")


def _reason(fault: Fault) -> str:
    """Return what is wrong with a value, in a user's words."""
    ctx = fault.get("ctx", {})
    match fault["type"]:
        case "too_short":
            return f"has {ctx['actual_length']} of at least {ctx['min_length']} items"
        case "too_long":
            return f"has {ctx['actual_length']} of at most {ctx['max_length']} items"
        case "list_type":
            return "a list belongs here: [..., ...], or each item in a line of its own, after a dash"
        case "model_type" | "dict_type":
            return "keys with values belong here, in lines of their own or in braces"
    return fault["msg"].lower()


def _model_at(kind: type[BaseModel], path: tuple[int | str, ...]) -> type[BaseModel]:
    """Return the model of the value at a path."""
    for part in path:
        if isinstance(part, str) and part in kind.model_fields:
            inner = _model_in(kind.model_fields[part].annotation)
            kind = inner or kind
    return kind


def _model_in(annotation: object) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    if get_origin(annotation) in (Union, UnionType, list) or get_args(annotation):
        return next((found for part in get_args(annotation) if (found := _model_in(part)) is not None), None)
    return None
