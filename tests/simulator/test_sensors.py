"""Errors of sensors."""

from __future__ import annotations

import math

import numpy as np
import pytest

from graphflow.simulator.robot import Battery, Lidar, Wheels
from graphflow.simulator.sensors import Charge, Odometry, noisy

LIDAR = Lidar(at=[0.0, 0.0, 0.2], beams=1000, range_min=0.12, range_max=3.5, rate=5.0, noise=0.01, dropouts=0.1)


def test_ranges() -> None:
    """They have noise and dropouts; nothing is seen beyond the limits."""
    dice = np.random.default_rng(1)
    found = noisy(np.full(1000, 2.0), LIDAR, dice)
    seen = found[np.isfinite(found)]
    assert 850 < len(seen) < 950
    assert seen.std() == pytest.approx(0.01, rel=0.2)
    assert seen.mean() == pytest.approx(2.0, abs=0.002)
    for distance in (-1.0, 0.05, 5.0):
        assert np.isinf(noisy(np.full(10, distance), LIDAR, dice)).all()
    assert found.dtype == np.float32


def test_odometry() -> None:
    """Straight on, around, and in steps of the encoder."""
    wheels = Wheels(radius=0.033, separation=0.16, mass=0.03, torque=0.5)
    straight = Odometry(wheels)
    for step in range(1, 101):
        straight.update(step * 0.1, step * 0.1, 0.01)
    assert (straight.x, straight.y, straight.yaw) == pytest.approx((10 * 0.033, 0.0, 0.0))
    assert (straight.linear, straight.angular) == pytest.approx((0.33, 0.0), abs=1e-6)
    around = Odometry(wheels)
    quarter = math.pi / 2 * 0.08 / 0.033
    for step in range(1, 101):
        around.update(-quarter * step / 100, quarter * step / 100, 0.01)
    assert (around.x, around.y, around.yaw) == pytest.approx((0.0, 0.0, math.pi / 2), abs=1e-9)
    coarse = Odometry(wheels.model_copy(update={"ticks": 10}))
    coarse.update(0.6, 0.6, 0.01)  # less than one of ten steps
    assert coarse.x == 0.0


def test_odometry_on_an_arc() -> None:
    """A step along an arc goes in the direction of its middle."""
    odometry = Odometry(Wheels(radius=0.1, separation=0.2, mass=0.1, torque=1.0))
    odometry.update(0.0, math.pi, 1.0)  # around the left wheel, which stands
    assert odometry.yaw == pytest.approx(math.pi / 2)
    way = 0.1 * math.pi / 2
    assert (odometry.x, odometry.y) == pytest.approx((way * math.sqrt(0.5), way * math.sqrt(0.5)))


def test_a_battery() -> None:
    """It loses charge and voltage, and never more than it has."""
    charge = Charge(Battery(voltage=12.0, capacity=1.0, idle=1.0, driving=1.0))
    for _ in range(1800):
        charge.update(0.0, 1.0)
    assert charge.share == pytest.approx(0.5)
    assert charge.voltage == pytest.approx(10.8)
    charge.update(1.0, 36_000.0)
    assert (charge.share, charge.current) == (0.0, 2.0)
