"""Physics of worlds and robots."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from graphflow.simulator.files import find, read_robot, read_world
from graphflow.simulator.mjcf import TICK
from graphflow.simulator.robot import Robot
from graphflow.simulator.simulation import SimulatedRobot, Simulation
from graphflow.simulator.world import World
from tests.cases import slow

ROBOTS = {name: read_robot(find(name, "robots", Path())) for name in ("burger", "waffle", "rover")}


def world(**parts: Any) -> Simulation:
    made = World.model_validate({"robots": [{"model": "burger"}], **parts})
    return Simulation(made, ROBOTS)


def drive(simulation: Simulation, seconds: float, *commands: float) -> SimulatedRobot:
    """Drive the first robot; commands are repeated, as programs do."""
    robot = next(iter(simulation.robots.values()))
    for step in range(round(seconds / TICK)):
        if commands and step % 20 == 0:
            robot.command(*commands)
        simulation.tick()
    return robot


@slow
@pytest.mark.parametrize("model", ROBOTS)
def test_a_robot_drives_as_commanded(model: str) -> None:
    """Straight on and around, to a few percent; its odometry knows nearly where it is."""
    robot = drive(world(robots=[{"model": model}]), 4.0, 0.2, 0.0)
    assert robot.pose.x == pytest.approx(0.8, rel=0.05)
    assert abs(robot.pose.y) < 0.01
    assert robot.odometry.x == pytest.approx(robot.pose.x, rel=0.03)
    turning = drive(world(robots=[{"model": model}]), 4.0, 0.0, 0.5)
    assert turning.pose.yaw == pytest.approx(2.0, rel=0.06)
    assert math.hypot(turning.pose.x, turning.pose.y) < 0.05


def test_limits_and_timeouts() -> None:
    """A burger drives no faster than it can, and stops when commands stop."""
    simulation = world()
    robot = drive(simulation, 2.0, 5.0, 0.0)
    assert robot.odometry.linear == pytest.approx(0.22, rel=0.05)
    drive(simulation, 1.5)
    assert abs(robot.odometry.linear) < 0.01
    with pytest.raises(ValueError, match=r"a velocity of nan m/s and 0.0 rad/s is not a command"):
        robot.command(math.nan, 0.0)


def test_a_scan() -> None:
    """A wall a metre ahead is seen there, nothing behind."""
    scan = world(walls=[{"points": [[1.0, -2.0], [1.0, 2.0]]}]).robots[""].scan()
    assert scan[0] == pytest.approx(1.0 - 0.05 + 0.032, abs=0.05) or math.isinf(scan[0])
    assert np.isinf(scan[120:240]).all()
    near = scan[np.isfinite(scan)].min()
    assert near == pytest.approx(0.982, abs=0.05)


def exact(**changes: Any) -> dict[str, Robot]:
    """Return the burger with a scanner that has no noise."""
    burger = ROBOTS["burger"]
    assert burger.lidar is not None
    lidar = burger.lidar.model_copy(update={"noise": 0.0, "dropouts": 0.0, **changes})
    return {"burger": burger.model_copy(update={"lidar": lidar})}


def test_beams_begin_at_the_scanner() -> None:
    """It is 3.2 cm behind the middle of a burger, which turns with it."""
    walls = [{"points": [[x, -2.0], [x, 2.0]], "thickness": 0.02} for x in (1.01, -2.01)]
    made = World.model_validate({"robots": [{"model": "burger"}], "walls": walls})
    simulation = Simulation(made, exact())
    robot = simulation.robots[""]
    scan = robot.scan()
    assert (scan[0], scan[180]) == pytest.approx((1.032, 1.968), abs=1e-3)
    robot.place(0.0, 0.0, math.pi / 2)
    simulation.tick()
    scan = robot.scan()
    assert (scan[270], scan[90]) == pytest.approx((1.0, 2.0), abs=5e-3)


def test_limits_of_acceleration() -> None:
    """A robot gets faster by no more than its motors may, on the straight and in turns."""
    straight, turning = drive(world(), 0.04, 0.22, 0.0), drive(world(), 0.04, 0.0, 2.84)
    assert straight.wheel_angles[1] * 0.033 < 0.5 * 2.5 * 0.05**2
    assert turning.wheel_angles[1] * 0.033 < 0.5 * 2.5 * 0.05**2


def test_collisions() -> None:
    """Driving into a wall is noticed; a light box is pushed away, a wall is not."""
    simulation = world(walls=[{"points": [[0.5, -1.0], [0.5, 1.0]]}])
    robot = drive(simulation, 4.0, 0.2, 0.0)
    assert robot.is_touching
    assert robot.collisions > 100
    assert robot.pose.x < 0.45
    assert robot.odometry.x > robot.pose.x + 0.05  # the wheels slip
    pushed = drive(world(boxes=[{"at": [0.3, 0.0], "size": [0.2, 0.2, 0.2], "mass": 0.1}]), 4.0, 0.2, 0.0)
    assert pushed.pose.x > 0.6


def test_ice() -> None:
    """On it the wheels turn, and the robot hardly moves."""
    robot = drive(world(friction=0.002), 2.0, 0.2, 0.0)
    assert robot.odometry.x > 0.3
    assert robot.pose.x < 0.1


def test_several_robots() -> None:
    """They see each other, and each takes its own commands."""
    simulation = world(robots=[{"name": "a"}, {"name": "b", "at": [1.0, 0.0]}])
    a, b = simulation.robots.values()
    assert np.nanmin(a.scan()) < 1.0
    a.command(0.0, 1.0)
    for _ in range(100):
        simulation.tick()
    assert abs(b.pose.yaw) < 0.01 < a.pose.yaw


@slow
def test_the_same_seed_gives_the_same_run() -> None:
    """Bit for bit, noise included; another seed does not."""

    def run(seed: int) -> tuple[Any, ...]:
        made, robots = read_world(find("hexagon", "worlds", Path()))
        simulation = Simulation(made, robots, seed)
        robot = drive(simulation, 3.0, 0.2, 0.4)
        return robot.pose, robot.scan().tobytes(), robot.imu().gyro.tobytes()

    assert run(1) == run(1)
    assert run(1)[0] == run(2)[0]
    assert run(1)[1] != run(2)[1]


def test_spawning_and_deleting() -> None:
    """The others go on from where they are, as fast as they were."""
    simulation = world()
    robot = drive(simulation, 2.0, 0.2, 0.5)
    before, time = robot.pose, simulation.time
    speed = robot._data.qvel.copy()
    placed = World.model_validate({"robots": [{"name": "new", "at": [3.0, 3.0]}]}).robots[0]
    simulation.spawn(placed, ROBOTS["rover"])
    assert robot.pose.x == pytest.approx(before.x)
    assert robot._data.qvel[: len(speed)] == pytest.approx(speed)
    assert simulation.time == time
    assert simulation.robots["new"].pose.x == pytest.approx(3.0)
    with pytest.raises(ValueError, match="there is a robot 'new' already"):
        simulation.spawn(placed, ROBOTS["rover"])
    simulation.delete("new")
    assert list(simulation.robots) == [""]
    drive(simulation, 1.0, 0.2, 0.0)
    assert robot.pose.x > before.x + 0.1


def test_reset() -> None:
    """Time, place, odometry and noise begin again."""
    simulation = world(walls=[{"points": [[1.0, -2.0], [1.0, 2.0]]}])
    first = simulation.robots[""].scan()
    robot = drive(simulation, 2.0, 0.2, 0.5)
    simulation.reset()
    assert simulation.time == 0.0
    assert (robot.pose.x, robot.odometry.x) == (0.0, 0.0)
    assert (robot.scan() == first).all()


def test_a_robot_stands_after_a_reset() -> None:
    """The speed that it had is forgotten; so it is when it is placed elsewhere."""
    simulation = world()
    robot = drive(simulation, 2.0, 0.2, 0.5)
    simulation.reset()
    drive(simulation, 0.5)
    assert (robot.pose.x, robot.pose.yaw) == pytest.approx((0.0, 0.0), abs=1e-4)
    drive(simulation, 2.0, 0.2, 0.0)
    robot.place(1.0, 1.0, 0.0)
    assert not robot._data.qvel.any()


def test_reset_after_a_deletion() -> None:
    """The noise of each robot is its own again."""
    simulation = world(
        robots=[{"model": "burger"}, {"model": "burger", "name": "second", "at": [3.0, 3.0]}],
        walls=[{"points": [[1.0, -2.0], [1.0, 2.0]]}],
    )
    second = simulation.robots["second"]
    simulation.delete("")
    first = second.scan()
    simulation.reset()
    assert (second.scan() == first).all()


def test_trouble() -> None:
    """A robot that lies on its side, or falls out of the world, is noticed."""
    simulation = world()
    robot = drive(simulation, 0.5)
    assert robot.trouble == ""
    robot.place(500.0, 0.0, 0.0)
    simulation.tick()
    assert robot.trouble == "it has left the world"
    robot.place(0.0, 0.0, 0.0)
    robot._data.qpos[robot._qpos + 2 : robot._qpos + 7] = [0.2, math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0]
    simulation.tick()
    assert robot.trouble == "it has fallen over"


def test_moving_obstacles() -> None:
    """They go along their path and back, whatever is in their way."""
    simulation = world(moving=[{"path": [[2.0, 2.0], [3.0, 2.0]], "speed": 0.5}])
    seen = []
    for _ in range(4):
        drive(simulation, 1.0)
        seen.append(float(simulation._data.mocap_pos[0, 0]))
    assert seen == pytest.approx([2.5, 3.0, 2.5, 2.0], abs=0.01)


def test_a_robot_without_sensors() -> None:
    """Asking for them is an error that says so."""
    bare = ROBOTS["burger"].model_copy(update={"lidar": None, "imu": None, "name": "bare"})
    robot = Simulation(World.model_validate({"robots": [{}]}), {"burger": bare}).robots[""]
    with pytest.raises(ValueError, match="a bare has no laser scanner"):
        robot.scan()
    with pytest.raises(ValueError, match="a bare has no IMU"):
        robot.imu()


def test_an_empty_battery() -> None:
    """The robot stands."""
    simulation = world()
    charge = simulation.robots[""].charge
    assert charge is not None
    charge.share = 0.0
    assert abs(drive(simulation, 1.0, 0.2, 0.0).pose.x) < 0.01


def test_a_world_that_mujoco_refuses(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its reason is the error."""
    monkeypatch.setattr("graphflow.simulator.simulation.model", lambda *_: "<mujoco><nonsense/></mujoco>")
    with pytest.raises(ValueError, match="MuJoCo refuses the world: "):
        world()
