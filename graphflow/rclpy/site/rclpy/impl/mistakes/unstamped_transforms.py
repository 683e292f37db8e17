"""Transforms on /tf that are sent again and again without a stamp, so that all seem to be of the same moment, 0.

tf2 drops each after the first as a repetition, and reports it at the listeners. One that is sent once may be meant so,
and at the moment 0 of a simulation the stamp is right.
"""

from __future__ import annotations

import logging
import sys
from typing import TYPE_CHECKING

from graphflow.analysis.user_code import short_place, users_frame, variable_of
from graphflow.errors import Place

if TYPE_CHECKING:
    from geometry_msgs.msg import TransformStamped

    from rclpy.node import Node

CHECKED = 100
"""Transforms of a broadcaster that are checked, at most: a program stamps all of them or none."""
_reported: set[Place] = set()
"""The lines that have been reported."""
logger = logging.getLogger("graphflow")


class Unstamped:
    """The check of one broadcaster."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._left = CHECKED
        self._frames: set[str] = set()
        """The frames whose transforms have been sent without a stamp."""

    def check(self, transform: TransformStamped) -> None:
        """Warn, once at the line that sends it, of the second transform of a frame that has no stamp."""
        if not self._left:
            return
        self._left -= 1
        stamp, frame = transform.header.stamp, transform.child_frame_id
        if stamp.sec or stamp.nanosec or not self._node.get_clock().now().nanoseconds:
            return
        caller = users_frame(sys._getframe(1)) if frame in self._frames else None
        self._frames.add(frame)
        if caller is None:
            return
        self._left = 0
        place = short_place(caller.f_code.co_filename, caller.f_lineno)
        if place not in _reported:
            _reported.add(place)
            name = variable_of(transform, [caller], "transform")
            logger.warning(
                "%s: the transforms of %r have no stamp, so that listeners take all of them for the same moment; write "
                "%s.header.stamp = self.get_clock().now().to_msg() before",
                *(place, frame, name),
            )
