"""A simulation of a world by its name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from graphflow.errors import GraphFileError, GraphflowError
from graphflow.introspect.installation import requirement
from graphflow.maps import read_map
from graphflow.names import check_node_name
from graphflow.simulator.files import find, misplaced, read_robot, read_world
from graphflow.simulator.robot import Robot
from graphflow.simulator.world import Placed, World

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
        file = find(world, "worlds", Path.cwd())
        described, robots = read_world(file)
        if model:
            robots = dict.fromkeys(robots, read_robot(find(model, "robots", Path.cwd())))
        made = Simulation(described, robots, seed)
    except (FileNotFoundError, ValueError) as error:
        raise GraphflowError(str(error)) from None
    faults = [_fault_of(made, placed, described) for placed in described.robots]
    if any(faults):
        raise GraphFileError(misplaced(file, faults))
    return made


def _fault_of(made: Simulation, placed: Placed, world: World) -> str:
    """Return the reason why a robot cannot start where it is placed; "" if it can."""
    x, y = placed.at
    if found := made.obstruction(placed.name):
        return f"the robot starts at ({x:g}, {y:g}), inside {found}"
    if world.map is not None:
        grid = read_map(world.map.file)
        if not grid.covers(x, y):
            (left, bottom, _), (width, height) = grid.origin, grid.size
            reach = f"from ({left:g}, {bottom:g}) to ({left + width:g}, {bottom + height:g})"
            return f"the robot starts at ({x:g}, {y:g}), outside the map, which reaches {reach}"
    return ""


def robot_model(name: str) -> Robot:
    """Return a robot by its name, such as `burger`, or by the path of its file.

    Raises:
        FileNotFoundError: There is none; the text lists the bundled ones.
        GraphFileError: The file has mistakes.
    """
    return read_robot(find(name, "robots", Path.cwd()))


def spawned(name: str, x: float, y: float, yaw: float) -> Placed:
    """Return a place for a robot of a name. Raises InvalidName if that is not a node's name."""
    check_node_name(name)
    return Placed(name=name, at=[x, y], yaw=yaw)
