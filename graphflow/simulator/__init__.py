"""Worlds, wheeled robots and their sensors on the physics engine MuJoCo (extra `sim`).

    simulation = simulate("hexagon", seed=1)
    simulation.robots[""].command(0.1, 0.3)
    simulation.tick()

Read `simulation` first: what a node steps and reads. `world` and `robot` are the files that describe worlds and robots,
`files` reads them, `mjcf` converts them to MuJoCo's model and `urdf` to descriptions, `sensors` has the errors of real
sensors, `cameras` draws images, and `loading` puts them together. The bundled worlds are in `worlds/`, the robots in
`robots/`. Knows no node; the only package that imports mujoco, when a simulation begins.
"""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from graphflow.simulator.loading import robot_model, simulate, spawned
from graphflow.simulator.robot import Robot
from graphflow.simulator.world import World

if TYPE_CHECKING:
    from graphflow.simulator.simulation import ImuReading, SimulatedRobot, Simulation

__all__ = ["ImuReading", "Robot", "SimulatedRobot", "Simulation", "World", "robot_model", "simulate", "spawned"]


if sys.platform == "linux" and not os.environ.get("DISPLAY"):
    # MuJoCo reads it when it is imported: only EGL draws the images of cameras without a display.
    os.environ.setdefault("MUJOCO_GL", "egl")


def __getattr__(name: str) -> object:
    if name in __all__:  # these need mujoco, which may not be installed
        from graphflow.simulator import simulation

        value: object = getattr(simulation, name)
        return value
    raise AttributeError(f"module 'graphflow.simulator' has no attribute {name!r}")
