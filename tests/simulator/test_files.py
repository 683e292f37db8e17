"""World and robot files: what is bundled, and each mistake at its line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from graphflow.errors import GraphFileError, GraphflowError
from graphflow.maps import GridMap, write_map
from graphflow.simulator import simulate
from graphflow.simulator.files import bundled, find, read_robot, read_world


@pytest.mark.parametrize("name", bundled("worlds"))
def test_bundled_worlds(name: str) -> None:
    """Each has a robot, of a model that is bundled."""
    world, robots = read_world(find(name, "worlds", Path()))
    assert {placed.model for placed in world.robots} == set(robots) == {"burger"}


def test_bundled_robots() -> None:
    """The burger has the numbers of its data sheet."""
    assert bundled("robots") == ["burger", "rover", "waffle"]
    burger, rover, _ = (read_robot(find(name, "robots", Path())) for name in bundled("robots"))
    assert (burger.wheels.radius, burger.wheels.separation) == (0.033, 0.160)
    assert (burger.max_linear, burger.max_angular) == (0.22, 2.84)
    assert burger.lidar is not None
    assert (burger.lidar.beams, burger.lidar.rate, burger.lidar.range_max) == (360, 5.0, 3.5)
    assert rover.base.radius == 0.17


MISTAKES = {
    "wals: []": ["w.yaml:1:1: unknown key 'wals'; did you mean 'walls'?"],
    "boxes: [{at: [1, 2], size: [1, -1, 1], yow: 2}]": ["1:32: -1: ", "1:40: unknown key 'yow'; did you mean 'yaw'?"],
    "boxes: [{size: [1, 1, 1]}]": ["1:9: the key 'at' is missing"],
    "cylinders: [{at: [1], radius: 1}]": ["1:18: [1]: has 1 of at least 2 items"],
    "cylinders: [{at: [1, .nan], radius: 1}]": ["1:22: nan: input should be a finite number"],
    "walls: [{points: [[0, 0], [0, 0]]}]": ["two neighbouring points of the wall are the same: [0, 0]"],
    "robots: [{model: burgr}]": ["1:18: there is no robot 'burgr'; did you mean 'burger'?"],
    "robots: [{model: mine.yaml}]": ["there is no file "],
    "robots: [{}, {}]": ["two robots have no name: their topics would be the same"],
    "robots: [{name: a}, {name: a}]": ["two robots are called 'a'"],
    "robots: [{name: 'a b'}]": ["'a b' is not a node name"],
    "friction: 0": ["1:11: 0: input should be greater than 0"],
    "walls: {}": ["1:8: {}: a list belongs here: [..., ...], or each item in a line of its own, after a dash"],
    "scene: no.xml": ["1:8: there is no file "],
    "scene: w.yaml": ["1:8: a scene is a file of MuJoCo or URDF, .xml, .mjcf, .urdf, not w.yaml"],
    "map: {file: no.yaml}": ["1:13: there is no file "],
    "map: {}": ["1:6: the key 'file' is missing"],
    "- a": ["1:1: ['a']: keys with values belong here, in lines of their own or in braces"],
}


@pytest.mark.parametrize("text", MISTAKES)
def test_mistakes(tmp_path: Path, text: str) -> None:
    """The error has the place, and what is right."""
    file = tmp_path / "w.yaml"
    file.write_text(text)
    with pytest.raises(GraphFileError) as caught:
        read_world(file)
    for part in MISTAKES[text]:
        assert part in str(caught.value)


def test_a_robot_file_beside_the_world(tmp_path: Path) -> None:
    """Its path starts at the world file; its mistakes have their own places."""
    (tmp_path / "w.yaml").write_text("robots: [{model: mine.yaml}]")
    mine = tmp_path / "mine.yaml"
    mine.write_text(find("burger", "robots", Path()).read_text())
    _, robots = read_world(tmp_path / "w.yaml")
    assert robots["mine.yaml"].name == "burger"
    mine.write_text("name: mine\nwheels: {radius: 0.1}\n")
    with pytest.raises(GraphFileError, match=r"mine.yaml:2:9: the key 'separation' is missing"):
        read_world(tmp_path / "w.yaml")


def test_a_missing_world() -> None:
    """The error lists what is there."""
    with pytest.raises(FileNotFoundError, match=r"no world 'hexagn'; did you mean 'hexagon'\?; bundled are empty"):
        find("hexagn", "worlds", Path())


def test_scenes_and_maps(tmp_path: Path) -> None:
    """Files of MuJoCo, URDF and map_server are worlds themselves, or part of one, with a robot in the middle."""
    scene = '<mujoco><worldbody><geom type="box" size=".1 .1 .5" pos="0.7 0 .5"/></worldbody></mujoco>'
    (tmp_path / "s.xml").write_text(scene)
    collision = '<collision><origin xyz="0.7 0 0.5"/><geometry><box size="0.2 0.2 1"/></geometry></collision>'
    (tmp_path / "s.urdf").write_text(f'<robot name="r"><link name="a">{collision}</link></robot>')
    cells = np.zeros((10, 20), np.int8)
    cells[:, 16:18] = 100
    write_map(GridMap(cells, 0.1, (-1.0, -0.5, 0.0)), tmp_path / "m")
    (tmp_path / "w.yaml").write_text("scene: s.xml\nmap: {file: m.yaml, height: 1.0}\nrobots: [{at: [0, 0]}]\n")
    for name in ("s.xml", "s.urdf", "m.yaml", "w.yaml"):
        simulation = simulate(str(tmp_path / name))
        for _ in range(10):
            simulation.tick()
        assert simulation.robots[""].scan()[0] == pytest.approx(0.6 + 0.032, abs=0.06), name


def test_a_scene_that_is_none(tmp_path: Path) -> None:
    """MuJoCo's reason is told, with the file."""
    (tmp_path / "s.xml").write_text("<mujoco><worldbody><geom/></worldbody></mujoco>")
    with pytest.raises(GraphflowError, match=r"MuJoCo refuses the world with .*s\.xml: "):
        simulate(str(tmp_path / "s.xml"))
