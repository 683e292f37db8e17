"""A loop that sleeps on the event loop, which what it waits for needs."""

from __future__ import annotations

import time

from graphflow import Node, Publisher, subscription, timer
from graphflow.msgs.std_msgs.msg import Bool


class Sprinter(Node):
    started = False

    @timer(0.2)
    def race(self) -> None:
        self.started = False
        while not self.started:
            time.sleep(0.05)  # stuck
        self.log.info("racing")

    @subscription(Bool, "shot")
    def on_shot(self, message: Bool) -> None:
        self.started = message.data


class Starter(Node):
    shot = Publisher(Bool, "shot")

    @timer(0.1)
    def shoot(self) -> None:
        self.shot.publish(Bool(data=True))
