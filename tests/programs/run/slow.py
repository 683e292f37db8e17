"""A node that blocks in a thread."""

from __future__ import annotations

import time

from graphflow import Node, timer


class Slow(Node):
    @timer(0.01, thread=True)
    def work(self) -> None:
        self.log.info("at work")
        time.sleep(600)
