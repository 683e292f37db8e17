"""A node that blocks its loop."""

from __future__ import annotations

from graphflow import Node, timer


class Stuck(Node):
    @timer(0.01)
    def work(self) -> None:
        self.log.info("at work")
        while True:
            pass
