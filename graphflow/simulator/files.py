"""Reading of world and robot files, with each mistake at its line."""

from __future__ import annotations

from pathlib import Path

from graphflow.errors import GraphFileError, Problem
from graphflow.markup import source
from graphflow.markup.validated import validated
from graphflow.names import nearest
from graphflow.simulator.robot import Robot
from graphflow.simulator.world import World

HERE = Path(__file__).parent


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
    world = validated(src, World)
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
    return validated(source.read_file(file, str(file)), Robot)
