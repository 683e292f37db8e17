"""Images of simulated cameras, where this machine can draw off screen."""

from __future__ import annotations

import math

import numpy as np
import pytest

from graphflow.errors import NoCamera
from graphflow.simulator import Simulation, simulate
from tests.cases import slow


@pytest.fixture
def simulation() -> Simulation:
    made = simulate("hexagon", 0, "waffle")
    for _ in range(10):
        made.tick()
    try:
        made.robots[""].image()
    except NoCamera as error:
        pytest.skip(str(error))
    return made


@slow
def test_an_image(simulation: Simulation) -> None:
    """It has the camera's size; sky is above, floor below, and pillars are blue."""
    image = simulation.robots[""].image()
    assert image.shape == (240, 320, 3)
    top, bottom = image[:20].mean(axis=(0, 1)), image[-20:].mean(axis=(0, 1))
    assert top.mean() > bottom.mean()
    assert (image[:, :, 2].astype(int) - image[:, :, 0] > 30).any()


@slow
def test_depths(simulation: Simulation) -> None:
    """The nearest pillar is about as far as the scanner says; the sky is infinitely far."""
    robot = simulation.robots[""]
    depth = robot.depth()
    assert depth.shape == (240, 320)
    assert np.isinf(depth[0]).any()
    assert 0.1 < depth[100:120].min() < 2.0


def test_a_robot_that_has_none() -> None:
    """It says so."""
    robot = simulate("empty").robots[""]
    with pytest.raises(ValueError, match="a burger has no camera"):
        robot.image()


def test_a_machine_that_cannot_draw(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error has the driver's reason, and what to install."""
    import mujoco

    def fail(*_: object) -> None:
        raise RuntimeError("no display")

    monkeypatch.setattr(mujoco, "Renderer", fail)
    with pytest.raises(NoCamera, match=r"cannot draw images off screen \(no display\); install EGL"):
        simulate("empty", 0, "waffle").robots[""].image()


def test_the_lens() -> None:
    """The angle of view and the focal length belong together."""
    camera = simulate("empty", 0, "waffle").robots[""].robot.camera
    assert camera is not None
    assert math.tan(camera.fov / 2) * camera.focal == pytest.approx(160)
    assert math.tan(camera.vertical_fov / 2) * camera.focal == pytest.approx(120)
