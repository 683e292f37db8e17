"""Robots with two driven wheels, described by numbers alone."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StrictStr

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Number = Annotated[float, Field(allow_inf_nan=False)]
Place = Annotated[list[Number], Field(min_length=3, max_length=3)]
"""x, y, z in metres."""


class Model(BaseModel):
    """The base of everything that a world or robot file has."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Base(Model):
    """The body: a box, or a cylinder if it has a radius.

    Attributes:
        size: Length, width and height of the box in metres.
        at: Its centre above the ground between the wheels.
        mass: In kilograms, without the wheels.
    """

    size: Annotated[list[Positive], Field(min_length=3, max_length=3)] | None = None
    radius: Positive | None = None
    height: Positive = 0.1
    at: Place
    mass: Positive


class Wheels(Model):
    """The two driven wheels.

    Attributes:
        radius, separation: In metres; the separation is that of the points that touch the ground.
        mass: In kilograms, of one wheel.
        torque: The most that a motor gives, in Nm.
        ticks: Encoder steps per turn, to which the odometry rounds; 0 for none.
    """

    radius: Positive
    separation: Positive
    mass: Positive
    torque: Positive
    ticks: Annotated[int, Field(ge=0)] = 0


class Lidar(Model):
    """A laser scanner.

    Attributes:
        at: Its place above the ground between the wheels.
        beams: Beams per turn.
        angle_min, angle_max: Radians of the first beam, and of the end of the turn.
        range_min, range_max: Metres.
        rate: Scans per second.
        noise: Standard deviation of a range in metres.
        dropouts: Share of beams that see nothing.
    """

    frame: StrictStr = "base_scan"
    at: Place
    beams: Annotated[int, Field(ge=1, le=20_000)]
    angle_min: Number = 0.0
    angle_max: Number = 6.283185307179586
    range_min: NotNegative
    range_max: Positive
    rate: Positive
    noise: NotNegative = 0.0
    dropouts: Annotated[float, Field(ge=0.0, le=1.0)] = 0.0


class Imu(Model):
    """An inertial measurement unit; its noise is a standard deviation.

    Attributes:
        rate: Messages per second.
        gyro_noise: In rad/s.
        accelerometer_noise: In m/s^2.
    """

    frame: StrictStr = "imu_link"
    at: Place
    rate: Positive
    gyro_noise: NotNegative = 0.0
    accelerometer_noise: NotNegative = 0.0


class Camera(Model):
    """A camera that looks ahead.

    Attributes:
        frame: Of the camera's body; that of its images, with z ahead, has `_optical` behind it.
        pitch: Radians by which it looks down.
        width, height: Of an image, in pixels.
        fov: The horizontal angle of view in radians.
        rate: Images per second.
        depth: Whether it also measures depths.
    """

    frame: StrictStr = "camera_link"
    at: Place
    pitch: Number = 0.0
    width: Annotated[int, Field(ge=8, le=1920)] = 320
    height: Annotated[int, Field(ge=8, le=1080)] = 240
    fov: Annotated[float, Field(gt=0.05, lt=2.8)] = 1.085
    rate: Positive = 10.0
    depth: bool = False

    @property
    def focal(self) -> float:
        """The focal length in pixels."""
        return self.width / 2 / math.tan(self.fov / 2)

    @property
    def vertical_fov(self) -> float:
        """The vertical angle of view in radians."""
        return 2 * math.atan(self.height / 2 / self.focal)


class Battery(Model):
    """A battery.

    Attributes:
        voltage: When it is full, in volts.
        capacity: In ampere hours.
        idle, driving: Current in amperes at rest, and additionally at full speed.
    """

    voltage: Positive
    capacity: Positive
    idle: NotNegative
    driving: NotNegative


class Robot(Model):
    """A robot with two driven wheels and a caster.

    Attributes:
        max_linear, max_angular: The limits of a command, in m/s and rad/s.
        max_acceleration: In m/s^2 at the wheels.
        command_timeout: Seconds after which a robot without commands stops.
        odom_rate: Odometry messages per second.
        caster: The caster's point on the ground, x and y in metres.
        base_frame, footprint_frame: The frames of the body, and of its point on the ground.
        base_height: The height of the base frame above the footprint.
    """

    name: StrictStr
    base: Base
    wheels: Wheels
    caster: Annotated[list[Number], Field(min_length=2, max_length=2)]
    max_linear: Positive
    max_angular: Positive
    max_acceleration: Positive = 2.5
    command_timeout: Positive = 1.0
    odom_rate: Positive = 30.0
    base_frame: StrictStr = "base_link"
    footprint_frame: StrictStr = "base_footprint"
    base_height: NotNegative = 0.01
    lidar: Lidar | None = None
    imu: Imu | None = None
    camera: Camera | None = None
    battery: Battery | None = None
