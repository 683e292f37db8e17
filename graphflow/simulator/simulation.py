"""A world in motion: its physics, its robots, and what their sensors see. The same seed gives the same run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from graphflow.simulator.cameras import Cameras
from graphflow.simulator.mjcf import FLOOR, STEPS, TICK, model, mover_name, obstacle
from graphflow.simulator.robot import Camera, Lidar, Robot
from graphflow.simulator.sensors import Charge, Odometry, noisy
from graphflow.simulator.urdf import described
from graphflow.simulator.world import EDGE, Mover, Placed, World
from graphflow.tf.planar import Pose2D

INSIDE = 0.01
"""Metres by which two bodies may overlap, since contacts are a little soft."""
FALLEN = 0.5
"""Cosine of the tilt beyond which a robot counts as fallen."""


@dataclass(frozen=True, slots=True)
class ImuReading:
    """The reading of an IMU.

    Attributes:
        orientation: A quaternion x, y, z, w.
        gyro: In rad/s.
        accelerometer: In m/s^2, with gravity.
    """

    orientation: tuple[float, float, float, float]
    gyro: NDArray[np.float64]
    accelerometer: NDArray[np.float64]


@dataclass(slots=True)
class SimulatedRobot:
    """A robot in a world. Made by `Simulation`.

    Attributes:
        seed: Of its noise.
        collisions: Ticks in which its body has touched an obstacle or another robot.
    """

    placed: Placed
    robot: Robot
    seed: tuple[int, int]
    odometry: Odometry = field(init=False)
    charge: Charge | None = field(init=False)
    collisions: int = field(init=False)
    is_touching: bool = field(init=False)
    has_timed_out: bool = field(init=False, default=False)
    """Whether a velocity has ended in this tick because no further command came."""
    _dice: np.random.Generator = field(init=False, repr=False)
    _target: tuple[float, float] = field(init=False)
    _speed: tuple[float, float] = field(init=False)
    _commanded: float = field(init=False)
    _model: mujoco.MjModel = field(init=False, repr=False)
    _data: mujoco.MjData = field(init=False, repr=False)
    _cameras: Cameras = field(init=False, repr=False)
    _body: int = field(init=False)
    _qpos: int = field(init=False)
    _wheels: tuple[int, int] = field(init=False)
    _motors: tuple[int, int] = field(init=False)
    _geoms: frozenset[int] = field(init=False, repr=False)
    _beams: NDArray[np.float64] | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """Begin again at time 0: at rest, with a full battery and new odometry, and with the same noise."""
        self.odometry = Odometry(self.robot.wheels)
        self.charge = None if self.robot.battery is None else Charge(self.robot.battery)
        self.collisions, self.is_touching = 0, False
        self._dice = np.random.default_rng(self.seed)
        self._target = self._speed = 0.0, 0.0
        self._commanded = -math.inf

    def bind(self, model: mujoco.MjModel, data: mujoco.MjData, cameras: Cameras) -> None:
        """Find the robot's parts in a model."""
        own = self.placed.name
        self._cameras = cameras
        self._model, self._data = model, data
        self._body = model.body(f"{own}/base").id
        self._qpos = int(model.joint(f"{own}/free").qposadr[0])
        left, right = (int(model.joint(f"{own}/{side}").qposadr[0]) for side in ("left", "right"))
        self._wheels = left, right
        self._motors = model.actuator(f"{own}/left").id, model.actuator(f"{own}/right").id
        self._geoms = frozenset(i for i in range(model.ngeom) if model.body_rootid[model.geom_bodyid[i]] == self._body)
        self._beams = None if self.robot.lidar is None else _beams(self.robot.lidar)

    def has(self, geom: int) -> bool:
        """Whether a geometry of the model is part of it."""
        return geom in self._geoms

    def command(self, linear: float, angular: float) -> None:
        """Set the wanted velocity in m/s and rad/s, within the robot's limits, until its commands time out.

        Raises:
            ValueError: A number is infinite or not a number.
        """
        if not (math.isfinite(linear) and math.isfinite(angular)):
            raise ValueError(f"a velocity of {linear} m/s and {angular} rad/s is not a command")
        most, turn = self.robot.max_linear, self.robot.max_angular
        self._target = min(most, max(-most, linear)), min(turn, max(-turn, angular))
        self._commanded = self._data.time

    def drive(self) -> None:
        """Let the motors follow the command over the next tick."""
        if self._data.time - self._commanded > self.robot.command_timeout:
            self.has_timed_out = self._target != (0.0, 0.0)
            self._target = 0.0, 0.0
        wheels, most = self.robot.wheels, self.robot.max_acceleration * TICK
        linear = self._speed[0] + min(most, max(-most, self._target[0] - self._speed[0]))
        turn = 2 * most / wheels.separation
        angular = self._speed[1] + min(turn, max(-turn, self._target[1] - self._speed[1]))
        self._speed = linear, angular
        if self.charge is not None and not self.charge.share:
            linear = angular = 0.0  # an empty battery drives nothing
        half = angular * wheels.separation / 2
        left, right = self._motors
        self._data.ctrl[left], self._data.ctrl[right] = (linear - half) / wheels.radius, (linear + half) / wheels.radius

    def observe(self, touching: frozenset[int]) -> None:
        """Read encoders and battery after a tick; `touching` has the geoms that touch something else than the floor."""
        left, right = self.wheel_angles
        self.odometry.update(left, right, TICK)
        if self.charge is not None:
            self.charge.update(abs(self._speed[0]) / self.robot.max_linear, TICK)
        self.is_touching = not touching.isdisjoint(self._geoms)
        self.collisions += self.is_touching

    @property
    def wheel_angles(self) -> tuple[float, float]:
        """The angles of the left and right wheel in radians."""
        left, right = self._wheels
        return float(self._data.qpos[left]), float(self._data.qpos[right])

    @property
    def pose(self) -> Pose2D:
        """Its true place."""
        x, y, _, w, i, j, k = self._data.qpos[self._qpos : self._qpos + 7]
        return Pose2D(float(x), float(y), math.atan2(2 * (w * k + i * j), 1 - 2 * (j * j + k * k)))

    def description(self, prefix: str = "") -> str:
        """Return its description in URDF; `prefix` precedes the names of its frames."""
        return described(self.robot, prefix)

    @property
    def trouble(self) -> str:
        """The reason why it cannot drive: it has fallen over, or left the world; "" if it can."""
        x, y, z, _, i, j, _ = self._data.qpos[self._qpos : self._qpos + 7]
        if not math.isfinite(x + y + z):
            return "the physics has become unstable"
        if 1 - 2 * (i * i + j * j) < FALLEN:
            return "it has fallen over"
        return "it has left the world" if max(abs(x), abs(y)) > EDGE or z < -1.0 else ""

    def place(self, x: float, y: float, yaw: float) -> None:
        """Put it upright at a place, at rest; its odometry does not know."""
        self._data.qpos[self._qpos : self._qpos + 7] = [x, y, 0.0, math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)]
        velocity = int(self._model.joint(f"{self.placed.name}/free").dofadr[0])
        self._data.qvel[velocity : velocity + 8] = 0.0  # the body's six, and the two wheels that follow them
        self._target = self._speed = 0.0, 0.0

    def scan(self) -> NDArray[np.float32]:
        """Return the ranges of a scan now, in metres, beam by beam.

        Raises:
            ValueError: The robot has no scanner.
        """
        lidar = self.robot.lidar
        if lidar is None or self._beams is None:
            raise ValueError(f"a {self.robot.name} has no laser scanner")
        turn = self._data.xmat[self._body].reshape(3, 3)
        origin = self._data.xpos[self._body] + turn @ lidar.at
        count = lidar.beams
        found, distances = np.zeros(count, np.int32), np.zeros(count)
        rays = np.ascontiguousarray(self._beams @ turn.T).ravel()
        # Its own body is left out; a cutoff beyond the range, since noise may bring a wall nearer.
        reach = lidar.range_max + 5 * lidar.noise
        mujoco.mj_multiRay(
            self._model, self._data, origin, rays, None, 1, self._body, found, distances, None, count, reach
        )
        return noisy(distances, lidar, self._dice)

    def image(self) -> NDArray[np.uint8]:
        """Return what its camera sees now: red, green and blue, of shape (height, width, 3).

        Raises:
            ValueError: The robot has no camera.
            NoCamera: This machine cannot draw off screen.
        """
        camera = self._camera()
        return self._cameras.image(f"{self.placed.name}/camera", camera.width, camera.height)

    def depth(self) -> NDArray[np.float32]:
        """Return the depths that its camera measures now, in metres, of shape (height, width). Raises as `image`."""
        camera = self._camera()
        return self._cameras.depth(f"{self.placed.name}/camera", camera.width, camera.height)

    def _camera(self) -> Camera:
        if self.robot.camera is None:
            raise ValueError(f"a {self.robot.name} has no camera")
        return self.robot.camera

    def imu(self) -> ImuReading:
        """Return what the IMU reports now.

        Raises:
            ValueError: The robot has none.
        """
        imu = self.robot.imu
        if imu is None:
            raise ValueError(f"a {self.robot.name} has no IMU")
        own = self.placed.name
        gyro = self._data.sensor(f"{own}/gyro").data + self._dice.normal(0.0, imu.gyro_noise, 3)
        pull = self._data.sensor(f"{own}/accelerometer").data + self._dice.normal(0.0, imu.accelerometer_noise, 3)
        w, x, y, z = (float(number) for number in self._data.qpos[self._qpos + 3 : self._qpos + 7])
        return ImuReading((x, y, z, w), gyro, pull)


def _beams(lidar: Lidar) -> NDArray[np.float64]:
    """Return the directions of a scanner's beams, of shape (beams, 3)."""
    angles = lidar.angle_min + np.arange(lidar.beams) * (lidar.angle_max - lidar.angle_min) / lidar.beams
    return np.stack([np.cos(angles), np.sin(angles), np.zeros(lidar.beams)], axis=1)


class Simulation:
    """A world in motion.

    Attributes:
        tick_seconds: The time that a tick lets pass.
        end: Metres from the origin, along x and y, at which the world ends.

    Args:
        models: The robots of the world, by the name of their model.
        seed: Of all noise.

    Raises:
        ValueError: MuJoCo refuses the world; the text has its reason.
    """

    tick_seconds: ClassVar[float] = TICK
    end: ClassVar[float] = EDGE

    def __init__(self, world: World, models: Mapping[str, Robot], seed: int = 0) -> None:
        self._world, self._seed, self._spawned = world, seed, 0
        self._former: tuple[mujoco.MjModel | None, mujoco.MjData | None] = None, None
        self._cameras: Cameras | None = None
        self.robots: dict[str, SimulatedRobot] = {}
        for placed in world.robots:
            self._add(placed, models[placed.model])
        self._movers = [_Motion(mover) for mover in world.moving]
        self._compile()

    @property
    def time(self) -> float:
        """Seconds since the start, or since the last reset."""
        return float(self._data.time)

    def _add(self, placed: Placed, robot: Robot) -> None:
        self.robots[placed.name] = SimulatedRobot(placed, robot, (self._seed, self._spawned))
        self._spawned += 1

    def _compile(self) -> None:
        """Make a model of the world and its robots; what moves goes on from where it is."""
        former, before = self._former
        text = model(self._world, [(robot.placed, robot.robot) for robot in self.robots.values()])
        try:
            spec = mujoco.MjSpec.from_string(text)
            if self._world.scene:
                scene = mujoco.MjSpec.from_file(self._world.scene)
                spec.attach(scene, frame=spec.worldbody.add_frame(), prefix="scene/")
            self._model = spec.compile()
        except ValueError as error:
            what = f" with {self._world.scene}" if self._world.scene else ""
            raise ValueError(f"MuJoCo refuses the world{what}: {error}") from None
        self._data = mujoco.MjData(self._model)
        if self._cameras is not None:
            self._cameras.close()
        self._cameras = Cameras(self._model, self._data)
        self._mocaps = [int(self._model.body(mover_name(i)).mocapid[0]) for i in range(len(self._movers))]
        self._floor = self._model.geom(FLOOR).id
        for robot in self.robots.values():
            robot.bind(self._model, self._data, self._cameras)
        if before is not None and former is not None:
            self._data.time = before.time
            _copy_state(former, before, self._model, self._data)
        mujoco.mj_forward(self._model, self._data)
        self._former = self._model, self._data

    def tick(self) -> None:
        """Let `TICK` seconds pass."""
        for robot in self.robots.values():
            robot.drive()
        for mocap, motion in zip(self._mocaps, self._movers, strict=True):
            self._data.mocap_pos[mocap, :2] = motion.place(self._data.time)
        mujoco.mj_step(self._model, self._data, STEPS)
        touching = self._touching()
        for robot in self.robots.values():
            robot.observe(touching)

    def _touching(self) -> frozenset[int]:
        """Return the geoms that touch something else than the floor."""
        contacts = self._data.contact
        if not len(contacts):
            return frozenset()
        pairs = contacts.geom
        return frozenset(pairs[(pairs != self._floor).all(axis=1)].ravel().tolist())

    def obstruction(self, name: str) -> str:
        """Describe what the body of a robot is inside of; "" if nothing."""
        own, contacts = self.robots[name], self._data.contact
        for pair, distance in zip(contacts.geom.tolist(), contacts.dist.tolist(), strict=True):
            others = [geom for geom in pair if not own.has(geom)]
            if distance < -INSIDE and len(others) == 1 and others[0] != self._floor:
                robots = [r.placed.name or r.robot.name for r in self.robots.values() if r.has(others[0])]
                return f"the robot {robots[0]!r}" if robots else obstacle(self._model.geom(others[0]).name)
        return ""

    def teleport(self, name: str, x: float, y: float, yaw: float) -> None:
        """Put a robot at a place, at rest; its odometry does not know.

        Raises:
            ValueError: Something else is there; the robot stays where it is.
        """
        robot, before = self.robots[name], self._data.qpos.copy()
        moving = self._data.qvel.copy()
        robot.place(x, y, yaw)
        mujoco.mj_forward(self._model, self._data)
        if found := self.obstruction(name):
            self._data.qpos[:], self._data.qvel[:] = before, moving
            mujoco.mj_forward(self._model, self._data)
            raise ValueError(f"({x:g}, {y:g}) is inside {found}")

    def spawn(self, placed: Placed, robot: Robot) -> None:
        """Add a robot.

        Raises:
            ValueError: There is one of that name, or something else is at its place.
        """
        if placed.name in self.robots:
            raise ValueError(f"there is a robot {placed.name!r} already")
        self._add(placed, robot)
        self._compile()
        if found := self.obstruction(placed.name):
            self.delete(placed.name)
            raise ValueError(f"({placed.at[0]:g}, {placed.at[1]:g}) is inside {found}")

    def delete(self, name: str) -> None:
        """Take a robot out of the world. Raises KeyError if there is none of that name."""
        del self.robots[name]
        self._compile()

    def reset(self) -> None:
        """Begin again: time, obstacles, robots of the world, and noise are as at the start; spawned robots stay."""
        mujoco.mj_resetData(self._model, self._data)
        for robot in self.robots.values():
            robot.restart()
        mujoco.mj_forward(self._model, self._data)


def _copy_state(former: mujoco.MjModel, before: mujoco.MjData, now: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Copy places and velocities of the joints that both models have, by name."""
    for index in range(former.njnt):
        name = former.joint(index).name
        if not name:
            continue
        try:
            joint = now.joint(name)
        except KeyError:
            continue
        count = len(former.joint(index).qpos0)
        start, there = int(former.jnt_qposadr[index]), int(joint.qposadr[0])
        data.qpos[there : there + count] = before.qpos[start : start + count]
        degrees = 6 if count == 7 else 1
        start, there = int(former.jnt_dofadr[index]), int(joint.dofadr[0])
        data.qvel[there : there + degrees] = before.qvel[start : start + degrees]


class _Motion:
    """The way of a moving obstacle: along its path, and back to its start."""

    def __init__(self, mover: Mover) -> None:
        points = np.array([*mover.path, mover.path[0]], dtype=np.float64)
        lengths = np.hypot(*np.diff(points, axis=0).T)
        self._points, self._ends, self._speed = points, np.concatenate([[0.0], np.cumsum(lengths)]), mover.speed

    def place(self, time: float) -> tuple[float, float]:
        """Return x and y at a time."""
        if self._ends[-1] == 0:
            return float(self._points[0, 0]), float(self._points[0, 1])
        way = time * self._speed % self._ends[-1]
        return float(np.interp(way, self._ends, self._points[:, 0])), float(
            np.interp(way, self._ends, self._points[:, 1])
        )
