"""ROS 2's lifecycle demo: a talker that is configured before it talks."""

from io import StringIO

import graphflow
from graphflow import LifecycleNode, Param, Publisher, timer
from graphflow.msgs.std_msgs.msg import String


class LifecycleTalker(LifecycleNode):
    """Publish greetings on `lifecycle_chatter` while active, and keep a diary from `configure` to `cleanup`."""

    node_name = "lc_talker"
    rate = Param(1.0, unit="Hz", gt=0.0, le=1000.0, doc="Greetings per second.")
    chatter = Publisher(String, "lifecycle_chatter")

    async def on_configure(self) -> None:
        self.diary = await self.enter(StringIO())
        self.count = 0
        self.log.info("on_configure() is called.")

    async def on_activate(self) -> None:
        self.log.info("on_activate() is called.")

    async def on_deactivate(self) -> None:
        self.log.info("on_deactivate() is called.")

    async def on_cleanup(self) -> None:
        self.diary.seek(0)
        self.log.info("on_cleanup() is called after %d greetings.", len(self.diary.readlines()))

    async def on_shutdown(self) -> None:
        self.log.info("on_shutdown() is called.")

    @timer(hz=rate)
    async def greet(self) -> None:
        self.count += 1
        message = String(data=f"Lifecycle HelloWorld #{self.count}")
        self.log.info("Publishing: [%s]", message.data)
        self.diary.write(f"{message.data}\n")
        self.chatter.publish(message)


if __name__ == "__main__":
    graphflow.run(LifecycleTalker)
