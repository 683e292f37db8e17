"""Reading of world and robot files, with each mistake at its line."""

from __future__ import annotations

from pathlib import Path
from types import UnionType
from typing import TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from graphflow.errors import GraphFileError, Problem
from graphflow.graph.model import Fault, keys_of
from graphflow.markup import source
from graphflow.names import did_you_mean, nearest
from graphflow.simulator.robot import Robot
from graphflow.simulator.world import World

HERE = Path(__file__).parent
M = TypeVar("M", bound=BaseModel)


def bundled(kind: str) -> list[str]:
    """Return the names of the bundled files: of `worlds`, or of `robots`."""
    return sorted(file.stem for file in (HERE / kind).glob("*.yaml"))


def find(name: str, kind: str, folder: Path) -> Path:
    """Return a bundled file by its name, or a file by its path.

    Args:
        kind: `worlds` or `robots`.
        folder: The folder at which a relative path starts.

    Raises:
        FileNotFoundError: There is neither; the text lists the bundled ones.
    """
    if "/" not in name and not name.endswith((".yaml", ".yml")):
        file, known = HERE / kind / f"{name}.yaml", bundled(kind)
        near = nearest(name, known)
        meant = f"; did you mean {near!r}?" if near else ""
        missing = f"there is no {kind[:-1]} {name!r}{meant}; bundled are {', '.join(known)}"
    else:
        file = folder / name
        missing = f"there is no file {file}"
    if not file.is_file():
        raise FileNotFoundError(missing)
    return file


def read_world(file: Path) -> tuple[World, dict[str, Robot]]:
    """Read a world file and the robots that it has; returns those by the name of their model.

    Raises:
        GraphFileError: A file has mistakes; all of them, with their places.
    """
    src = source.read_file(file, str(file))
    world = _validated(src, World)
    robots: dict[str, Robot] = {}
    problems = []
    for index, placed in enumerate(world.robots):
        try:
            robots.setdefault(placed.model, read_robot(find(placed.model, "robots", file.parent)))
        except FileNotFoundError as error:
            problems.append(Problem(src.place(("robots", index, "model")), str(error)))
    if problems:
        raise GraphFileError(problems)
    return world, robots


def read_robot(file: Path) -> Robot:
    """Read a robot file.

    Raises:
        GraphFileError: It has mistakes; all of them, with their places.
    """
    return _validated(source.read_file(file, str(file)), Robot)


def _validated(src: source.Source, kind: type[M]) -> M:
    try:
        return kind.model_validate({} if src.data is None else src.data)
    except ValidationError as error:
        raise GraphFileError([_problem(src, fault, kind) for fault in error.errors()]) from None


def _problem(src: source.Source, fault: Fault, kind: type[BaseModel]) -> Problem:
    path = tuple(fault["loc"])
    if fault["type"] == "extra_forbidden":
        known = keys_of(_model_at(kind, path[:-1]))
        near = did_you_mean(str(path[-1]), known) or f"; known are {', '.join(sorted(known))}"
        text = f"unknown key {path[-1]!r}{near}"
        return Problem(src.key_place(path), text)
    if fault["type"] == "missing":
        return Problem(src.place(path[:-1]), f"the key {path[-1]!r} is missing")
    if fault["type"] == "value_error":
        return Problem(src.place(path), str(fault["ctx"]["error"]))
    return Problem(src.place(path), f"{fault['input']!r}: {fault['msg'].lower()}")


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
