"""Conversion of a world and its robots to a model of MuJoCo, in its XML format MJCF."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from xml.etree.ElementTree import Element, SubElement, tostring

from graphflow.maps import read_map
from graphflow.maps.rectangles import rectangles
from graphflow.simulator.robot import Robot
from graphflow.simulator.world import Placed, Wall, World

TIMESTEP = 0.0025
"""Seconds of one step of the physics."""
STEPS = 2
TICK = STEPS * TIMESTEP
"""Seconds of a tick, after which sensors may be read."""
FLOOR = "floor"
WALL, OBSTACLE, LOOSE, MOVING = "0.85 0.82 0.75 1", "0.45 0.55 0.7 1", "0.85 0.55 0.25 1", "0.75 0.3 0.3 1"
"""Colours of walls, and of obstacles that stand, can be pushed, and move: red, green, blue, opacity."""
BODY = "0.25 0.28 0.32 1"
CASTER_RADIUS = 0.008
WHEEL_WIDTH = 0.003
"""Half the width in metres of a wheel's contact; a wide one would scrub in turns, as a rubber tyre does not."""


def model(world: World, robots: Sequence[tuple[Placed, Robot]]) -> str:
    """Return the MJCF text of a world with some robots, each at its place.

    Bodies, joints, actuators and sensors of a robot are called `NAME/base`, `NAME/left` and so on.
    """
    root = Element("mujoco", model="world")
    SubElement(root, "compiler", angle="radian")
    SubElement(root, "option", timestep=f"{TIMESTEP}", integrator="implicitfast", cone="elliptic")
    SubElement(root, "size", memory="64M")
    _looks(root)
    body = SubElement(root, "worldbody")
    # `condim` 3 has no rolling friction; the larger friction of two touching bodies counts.
    SubElement(
        body,
        "geom",
        name=FLOOR,
        type="plane",
        size="0 0 1",
        material="floor",
        friction=f"{world.friction} 0.005 0.0001",
    )
    _obstacles(body, world)
    actuators, sensors = SubElement(root, "actuator"), SubElement(root, "sensor")
    for placed, robot in robots:
        _robot(body, actuators, sensors, placed, robot, world.friction)
    return tostring(root, encoding="unicode")


def _looks(root: Element) -> None:
    """Describe what cameras see: light, colours, and a floor of squares by which one sees it move."""
    visual = SubElement(root, "visual")
    SubElement(visual, "global", offwidth="1920", offheight="1080")
    SubElement(visual, "headlight", ambient="0.4 0.4 0.4", diffuse="0.5 0.5 0.5")
    SubElement(visual, "map", znear="0.005", zfar="50")
    asset = SubElement(root, "asset")
    sky = {"type": "skybox", "builtin": "gradient", "rgb1": "0.6 0.75 0.9", "rgb2": "0.9 0.95 1"}
    SubElement(asset, "texture", sky, name="sky", width="256", height="256")
    squares = {"type": "2d", "builtin": "checker", "rgb1": "0.75 0.75 0.72", "rgb2": "0.62 0.62 0.6"}
    SubElement(asset, "texture", squares, name="squares", width="256", height="256")
    SubElement(asset, "material", name="floor", texture="squares", texuniform="true", texrepeat="2 2")


def _obstacles(parent: Element, world: World) -> None:
    if world.map is not None:
        grid = read_map(world.map.file)
        turn, up = _text([0, 0, grid.origin[2]]), world.map.height / 2
        for index, part in enumerate(rectangles(grid)):
            half, place = [part.width / 2, part.height / 2, up], [part.x, part.y, up]
            solid = {"name": f"map{index}", "type": "box", "rgba": WALL}
            SubElement(parent, "geom", solid, size=_text(half), pos=_text(place), euler=turn)
    for number, wall in enumerate(world.walls):
        for index, ((x, y), (u, v)) in enumerate(_segments(wall)):
            length, yaw = math.hypot(u - x, v - y), math.atan2(v - y, u - x)
            half = [length / 2 + wall.thickness / 2, wall.thickness / 2, wall.height / 2]
            place = [(x + u) / 2, (y + v) / 2, wall.height / 2]
            solid = {"name": f"wall{number}.{index}", "type": "box", "rgba": WALL}
            SubElement(parent, "geom", solid, size=_text(half), pos=_text(place), euler=_text([0, 0, yaw]))
    for index, box in enumerate(world.boxes):
        length, width, height = box.size
        solid = {"type": "box", "size": _text([length / 2, width / 2, height / 2])}
        _solid(parent, f"box{index}", [*box.at, height / 2], box.yaw, box.mass, solid)
    for index, cylinder in enumerate(world.cylinders):
        solid = {"type": "cylinder", "size": _text([cylinder.radius, cylinder.height / 2])}
        _solid(parent, f"cylinder{index}", [*cylinder.at, cylinder.height / 2], 0.0, cylinder.mass, solid)
    for index, mover in enumerate(world.moving):
        body = SubElement(parent, "body", name=mover_name(index), mocap="true", pos=_text([*mover.path[0], 0.0]))
        size = _text([mover.radius, mover.height / 2])
        upright = {"name": mover_name(index), "type": "cylinder", "rgba": MOVING}
        SubElement(body, "geom", upright, size=size, pos=_text([0, 0, mover.height / 2]))


KINDS = {"map": "a wall of the map", "wall": "a wall", "box": "a box", "cylinder": "a cylinder", "mover": "an obstacle"}


def obstacle(name: str) -> str:
    """Describe an obstacle by the name of its geometry, such as `box3`."""
    return KINDS.get(name.rstrip("0123456789."), "a part of the scene")


def mover_name(index: int) -> str:
    """Return the name of the body of a moving obstacle."""
    return f"mover{index}"


def _segments(wall: Wall) -> Iterable[tuple[Sequence[float], Sequence[float]]]:
    points = [*wall.points, wall.points[0]] if wall.closed else wall.points
    return zip(points, points[1:], strict=False)


def _solid(parent: Element, name: str, place: Sequence[float], yaw: float, mass: float, solid: dict[str, str]) -> None:
    if mass:  # it can be pushed
        body = SubElement(parent, "body", name=name, pos=_text(place), euler=_text([0, 0, yaw]))
        SubElement(body, "freejoint")
        SubElement(
            body, "geom", {**solid, "name": name, "mass": f"{mass}", "friction": "0.6 0.005 0.0001", "rgba": LOOSE}
        )
    else:
        SubElement(
            parent, "geom", {**solid, "name": name, "rgba": OBSTACLE, "pos": _text(place), "euler": _text([0, 0, yaw])}
        )


def _robot(
    parent: Element, actuators: Element, sensors: Element, placed: Placed, robot: Robot, friction: float
) -> None:
    own = placed.name
    body = SubElement(
        parent, "body", name=f"{own}/base", pos=_text([*placed.at, 0.0]), euler=_text([0.0, 0.0, placed.yaw])
    )
    SubElement(body, "freejoint", name=f"{own}/free")
    base = robot.base
    if base.radius is not None:
        solid = {"type": "cylinder", "size": _text([base.radius, base.height / 2])}
    else:
        length, width, height = base.size or (0.1, 0.1, base.height)
        solid = {"type": "box", "size": _text([length / 2, width / 2, height / 2])}
    solid |= {"rgba": BODY, "name": f"{own}/body", "pos": _text(base.at), "mass": f"{base.mass}"}
    SubElement(body, "geom", solid)
    if robot.lidar is not None:  # what the scanners of other robots see
        SubElement(body, "geom", type="cylinder", size="0.035 0.02", pos=_text(robot.lidar.at), mass="0.05")
    caster = [*robot.caster, CASTER_RADIUS]
    # `priority` lets the caster's own friction count, not the floor's.
    SubElement(
        body, "geom", type="sphere", size=f"{CASTER_RADIUS}", pos=_text(caster), mass="0.005", condim="1", priority="1"
    )
    camera = robot.camera
    if camera is not None:
        # A camera of MuJoCo looks along its -z axis, with x to the right and y up.
        sine, cosine = math.sin(camera.pitch), math.cos(camera.pitch)
        axes = _text([0.0, -1.0, 0.0, sine, 0.0, cosine])
        fovy = f"{math.degrees(camera.vertical_fov)}"
        SubElement(body, "camera", name=f"{own}/camera", pos=_text(camera.at), xyaxes=axes, fovy=fovy)
    imu = robot.imu.at if robot.imu is not None else base.at
    SubElement(body, "site", name=f"{own}/imu", pos=_text(imu))
    wheels = robot.wheels
    for side, y in (("left", wheels.separation / 2), ("right", -wheels.separation / 2)):
        wheel = SubElement(body, "body", name=f"{own}/{side}_wheel", pos=_text([0.0, y, wheels.radius]))
        SubElement(
            wheel, "joint", name=f"{own}/{side}", type="hinge", axis="0 1 0", damping="0.0001", armature="0.0005"
        )
        SubElement(
            wheel,
            "geom",
            name=f"{own}/{side}_tyre",
            type="cylinder",
            size=_text([wheels.radius, WHEEL_WIDTH]),
            euler=_text([math.pi / 2, 0.0, 0.0]),
            mass=f"{wheels.mass}",
            friction=f"{1.5 * friction} 0.0001 0.0001",
            priority="1",
        )
        limit = _text([-wheels.torque, wheels.torque])
        SubElement(actuators, "velocity", name=f"{own}/{side}", joint=f"{own}/{side}", kv="1.0", forcerange=limit)
    SubElement(sensors, "gyro", name=f"{own}/gyro", site=f"{own}/imu")
    SubElement(sensors, "accelerometer", name=f"{own}/accelerometer", site=f"{own}/imu")


def _text(numbers: Iterable[float]) -> str:
    return " ".join(f"{number:.9g}" for number in numbers)
