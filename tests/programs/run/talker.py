"""A node that is called like one that comes with graphflow."""

from __future__ import annotations

from graphflow import Node, timer


class Talker(Node):
    @timer(0.1)
    def say(self) -> None:
        self.log.info("this is mine")
