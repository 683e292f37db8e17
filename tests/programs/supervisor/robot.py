"""A module with a node and another class, which prints while it is imported."""

from __future__ import annotations

import sys

from graphflow import Node, Param, subscription
from graphflow.msgs.std_msgs.msg import String

print("this goes nowhere")
print("nor does this", file=sys.stderr)


class Robot(Node):
    """A robot."""

    rate = Param(10.0, gt=0.0, unit="Hz", doc="How often.")

    @subscription(String, "words")
    async def heard(self, message: String) -> None: ...


class Wheel: ...
