"""Transforms that every listener drops: without frame names, or with a rotation that is not normalized.

In ROS 2 the listeners report it, but not the sender, whose mistake it is.
"""

from __future__ import annotations

import logging
import math
import sys
from typing import TYPE_CHECKING

from graphflow.analysis.user_code import short_place, users_frame, variable_of
from graphflow.errors import Place
from graphflow.tf.faults import TOLERANCE

if TYPE_CHECKING:
    from geometry_msgs.msg import Quaternion, Transform, TransformStamped


_EULER = "x, y, z, w = tf_transformations.quaternion_from_euler(roll, pitch, yaw)"
_reported: set[Place] = set()
"""The lines that have been reported."""
logger = logging.getLogger("graphflow")


def check(transform: TransformStamped) -> None:
    """Warn, once at the line that sends it, of a transform that every listener drops."""
    fault = _of_names(transform.child_frame_id, transform.header.frame_id)
    fault = fault or _of_numbers(transform.transform, transform.child_frame_id)
    caller = users_frame(sys._getframe(1)) if fault else None
    if caller is None:
        return
    place = short_place(caller.f_code.co_filename, caller.f_lineno)
    if place not in _reported:
        _reported.add(place)
        wrong, way = fault
        way = way.replace("transform.", f"{variable_of(transform, [caller], 'transform')}.")
        logger.warning("%s: %s, and every listener drops it; %s", place, wrong, way)


def _of_names(frame: str, parent: str) -> tuple[str, ...]:
    """Describe the fault of a transform's frame names, and what to write; empty if there is none."""
    if not frame or not parent:
        lacking = "child_frame_id" if parent else "header.frame_id"
        return f"this transform has no {lacking}", f"write transform.{lacking} = 'base_link' before"
    if frame == parent:
        way = "child_frame_id is the frame that is placed in frame_id"
        return f"this transform says where {frame!r} is in itself", way
    return ()


def _of_numbers(transform: Transform, frame: str) -> tuple[str, ...]:
    """Describe the fault of a transform's numbers, and what to write; empty if there is none."""
    turn, move = transform.rotation, transform.translation
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    squared = x * x + y * y + z * z + w * w
    if abs(squared - 1) <= TOLERANCE and math.isfinite(move.x + move.y + move.z):
        return ()
    numbers = {"translation.x": move.x, "translation.y": move.y, "translation.z": move.z}
    numbers |= {"rotation.x": x, "rotation.y": y, "rotation.z": z, "rotation.w": w}
    wrong = next((name for name, number in numbers.items() if not math.isfinite(number)), None)
    if wrong is not None:
        return f"{wrong} of the transform of {frame!r} is {numbers[wrong]}", "check the number before it is sent"
    if abs(squared - 1) <= TOLERANCE:
        return ()
    fault = f"the rotation of {frame!r} is a quaternion of length {math.sqrt(squared):.4g}, not 1"
    is_angle = w in (0, 1) and squared > w
    return fault, _of_angle(turn) if is_angle else _way_to_unit(squared)


def _of_angle(turn: Quaternion) -> str:
    """Return how the angle in a rotation is converted."""
    axes = [axis for axis in "xyz" if getattr(turn, axis)]
    if len(axes) > 1:
        return f"angles are converted: {_EULER}, in radians"
    part = f"transform.rotation.{axes[0]} = math.sin(angle / 2)"
    return f"for an angle in radians write {part} and transform.rotation.w = math.cos(angle / 2)"


def _way_to_unit(squared: float) -> str:
    return "divide x, y, z and w by that length" if squared else "no rotation has w = 1.0"
