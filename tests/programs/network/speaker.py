"""A node that says a word on a latched topic each time it is told to."""

from __future__ import annotations

from graphflow import Durability, Node, Publisher, Qos, service
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Trigger


class Speaker(Node):
    said = Publisher(String, "said", Qos(depth=1, durability=Durability.TRANSIENT_LOCAL))
    times = 0

    async def on_start(self) -> None:
        self.log.info("listening")

    @service(Trigger, "speak")
    async def speak(self, request: Trigger.Request) -> Trigger.Response:
        self.times += 1
        self.said.publish(String(data=f"word {self.times}"))
        return Trigger.Response(success=True)
