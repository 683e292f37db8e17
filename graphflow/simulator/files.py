"""Reading of world and robot files, with each mistake at its line."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from graphflow.errors import GraphFileError, Place, Problem
from graphflow.markup import source
from graphflow.markup.validated import validated
from graphflow.names import nearest
from graphflow.simulator.robot import Robot
from graphflow.simulator.world import World

HERE = Path(__file__).parent
SCENES = (".xml", ".mjcf", ".urdf")
"""Endings of files that MuJoCo reads itself."""


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
    if "/" not in name and not name.endswith((".yaml", ".yml", *SCENES)):
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
    if file.suffix in SCENES:
        return _with_a_robot(scene=str(file.resolve())), {"burger": read_robot(find("burger", "robots", file))}
    src = source.read_file(file, str(file))
    if isinstance(src.data, dict) and {"image", "resolution"} <= src.data.keys():  # a map's file in place of a world's
        world = _with_a_robot(map={"file": str(file.resolve())})
    else:
        world = _located(validated(src, World), src, file.parent)
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


def misplaced(file: Path, faults: Sequence[str]) -> list[Problem]:
    """Return the faults of the places of a world's robots, "" for none, as problems with their places in its file."""
    src = None if file.suffix in SCENES else source.read_file(file, str(file))
    places = [Place(str(file)) if src is None else src.place(("robots", i, "at")) for i in range(len(faults))]
    return [Problem(place, fault) for place, fault in zip(places, faults, strict=True) if fault]


def _with_a_robot(**parts: object) -> World:
    """Return a world of some parts with a robot in its middle."""
    return World.model_validate({**parts, "robots": [{}]})


def _located(world: World, src: source.Source, folder: Path) -> World:
    """Return a world with whole paths.

    Raises:
        GraphFileError: A file does not exist.
    """
    changes: dict[str, object] = {}
    problems = []
    for key, name in (("scene", world.scene), ("map", world.map.file if world.map is not None else "")):
        if not name:
            continue
        found = (folder / name).resolve()
        place = src.place(("map", "file") if key == "map" else (key,))
        if not found.is_file():
            problems.append(Problem(place, f"there is no file {found}"))
        elif key == "scene" and found.suffix not in SCENES:
            problems.append(Problem(place, f"a scene is a file of MuJoCo or URDF, {', '.join(SCENES)}, not {name}"))
        changes[key] = world.map.model_copy(update={"file": str(found)}) if key == "map" and world.map else str(found)
    if problems:
        raise GraphFileError(problems)
    return world.model_copy(update=changes)


def read_robot(file: Path) -> Robot:
    """Read a robot file.

    Raises:
        GraphFileError: It has mistakes; all of them, with their places.
    """
    return validated(source.read_file(file, str(file)), Robot)
