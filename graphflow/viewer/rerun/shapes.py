"""The shapes of robots' links, from their descriptions, for Rerun."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeAlias

import rerun as rr

from graphflow.description import Robot, mesh_file
from graphflow.description.robot import Shape

Logged: TypeAlias = tuple[str, str, rr.AsComponents]
"""The path of an entity, the frame that it is in ("" for none), and what is logged there, an archetype of Rerun."""


def robot_shapes(robot: Robot, beside: Path) -> Iterator[Logged]:
    """Yield the shapes of a robot's links, each in the frame of its link; meshes that are not found are left out.

    Args:
        beside: The folder from which packages of meshes are searched.
    """
    for link in robot.links.values():
        for index, shape in enumerate(link.visuals):
            made = _archetype(shape, beside)
            if made is not None:
                path = f"robot/{robot.name}/{link.name}/{index}"
                yield path, link.name, made
                if shape.kind == "mesh":
                    x, y, z = shape.origin.translation
                    yield (
                        path,
                        link.name,
                        rr.InstancePoses3D(
                            translations=[[x, y, z]], quaternions=[shape.origin.rotation], scales=[shape.size]
                        ),
                    )


def _archetype(shape: Shape, beside: Path) -> rr.AsComponents | None:
    place: dict[str, Any] = {"centers": [shape.origin.translation], "quaternions": [shape.origin.rotation]}
    place |= {"colors": [[round(255 * part) for part in shape.colour]]} if shape.colour is not None else {}
    place["fill_mode"] = "solid"
    match shape.kind:
        case "box":
            return rr.Boxes3D(sizes=[shape.size], **place)
        case "cylinder":
            return rr.Cylinders3D(radii=[shape.size[0]], lengths=[shape.size[1]], **place)
        case "sphere":
            return rr.Ellipsoids3D(half_sizes=[[shape.size[0]] * 3], **place)
    file = mesh_file(shape.mesh, beside)
    return None if file is None else rr.Asset3D(path=file)
