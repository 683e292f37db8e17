"""A simulation of a world by its name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import ValidationError

from graphflow.errors import GraphflowError
from graphflow.introspect.installation import requirement
from graphflow.simulator.files import find, read_robot, read_world
from graphflow.simulator.robot import Robot
from graphflow.simulator.world import Placed

if TYPE_CHECKING:
    from graphflow.simulator.simulation import Simulation


def simulate(world: str, seed: int = 0, model: str = "") -> Simulation:
    """Return the simulation of a world.

    Args:
        world: A bundled world, or the path of a world file.
        model: A robot in place of those of the world, by its name or the path of its file.
        seed: Of all noise; the same seed gives the same run.

    Raises:
        GraphflowError: MuJoCo or the world is missing; the text says what to install, or which worlds there are.
        GraphFileError: The file has mistakes.
    """
    try:
        from graphflow.simulator.simulation import Simulation
    except ImportError as error:
        if error.name != "mujoco":
            raise
        raise GraphflowError(f"the simulator needs MuJoCo: pip install {requirement('sim')}") from None
    try:
        described, robots = read_world(find(world, "worlds", Path.cwd()))
        if model:
            robots = dict.fromkeys(robots, read_robot(find(model, "robots", Path.cwd())))
        return Simulation(described, robots, seed)
    except (FileNotFoundError, ValueError) as error:
        raise GraphflowError(str(error)) from None


def robot_model(name: str) -> Robot:
    """Return a robot by its name, such as `burger`, or by the path of its file.

    Raises:
        FileNotFoundError: There is none; the text lists the bundled ones.
        GraphFileError: The file has mistakes.
    """
    return read_robot(find(name, "robots", Path.cwd()))


def spawned(name: str, x: float, y: float, yaw: float) -> Placed:
    """Return a place for a robot of a name. Raises ValueError if that is not a node's name."""
    try:
        return Placed(name=name, at=[x, y], yaw=yaw)
    except ValidationError as error:
        raise ValueError("; ".join(str(fault["msg"]) for fault in error.errors())) from None
