"""Transforms that are sent without frame names: every listener drops them.

In ROS 2 the listeners report it, but not the sender, whose mistake it is.
"""

from __future__ import annotations

import logging
import sys
from typing import TYPE_CHECKING

from graphflow.analysis.user_code import short_place, users_frame
from graphflow.errors import Place

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped


_reported: set[Place] = set()
"""The lines that have been reported."""
logger = logging.getLogger("graphflow")


def check(transform: TransformStamped) -> None:
    """Warn, at the line that sends it, of a transform that lacks frame names, or names one frame twice."""
    frame, parent = transform.child_frame_id, transform.header.frame_id
    if frame and parent and frame != parent:
        return
    caller = users_frame(sys._getframe(1))
    if caller is None:
        return
    place = short_place(caller.f_code.co_filename, caller.f_lineno)
    if place in _reported:
        return
    _reported.add(place)
    if frame and parent:
        wrong, way = f"says where {frame!r} is in itself", "child_frame_id is the frame that is placed in frame_id"
    else:
        lacking = "child_frame_id" if parent else "header.frame_id"
        wrong, way = f"has no {lacking}", f"write transform.{lacking} = 'base_link' before"
    logger.warning("%s: this transform %s, and every listener drops it; %s", place, wrong, way)
