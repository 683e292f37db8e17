"""A node with a parameter of each kind; a script that runs it."""

from __future__ import annotations

from typing import Any

import graphflow
from graphflow import Node, Param


class Robot(Node):
    title = Param("5", doc="Looks like a number.")
    flag = Param("on")
    gain = Param(2.0, ge=0.0, le=10.0, step=0.5, unit="m", doc="How much.")
    count = Param(3, gt=0)
    words = Param(["a", "1"])
    limits_speed = Param(1.0, name="limits.speed")
    raw = Param(b"\x01\xff")
    fixed = Param("stays", read_only=True)

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        self.declare_parameter("extra", 1, dynamic=True)

    async def on_start(self) -> None:
        self.log.info("ready")


if __name__ == "__main__":
    graphflow.run(Robot)
