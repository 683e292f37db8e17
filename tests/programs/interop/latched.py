"""A talker that keeps its last three messages, and a listener that asks for them; a script that runs one by name."""

from __future__ import annotations

import sys

import graphflow
from graphflow import Durability, Node, Publisher, Qos, subscription, task
from graphflow.msgs.std_msgs.msg import String

KEPT = Qos(depth=3, durability=Durability.TRANSIENT_LOCAL)


class Hear(Node):
    @subscription(String, "chatter", KEPT)
    async def heard(self, m: String) -> None:
        print("HEARD", m.data, flush=True)


class Say(Node):
    chatter = Publisher(String, "chatter", KEPT)

    @task
    async def say(self) -> None:
        for n in range(1, 6):
            self.chatter.publish(String(data=f"new {n}"))
        print("SAID", flush=True)


if __name__ == "__main__":
    graphflow.run(globals()[sys.argv.pop(1)])
