"""The talker of the ROS 2 tutorials: a publisher and a timer."""

import graphflow
from graphflow import Node, Param, Publisher, timer
from graphflow.msgs.std_msgs.msg import String


class Talker(Node):
    """Publish greetings on `chatter`, `rate` times a second."""

    rate = Param(1.0, unit="Hz", gt=0.0, le=1000.0, doc="Greetings per second.")
    greeting = Param("Hello World", doc="What to say.")
    chatter = Publisher(String, "chatter")
    count = 0

    @timer(hz=rate)
    async def greet(self) -> None:
        self.count += 1
        message = String(data=f"{self.greeting}: {self.count}")
        self.log.info("Publishing: '%s'", message.data)
        self.chatter.publish(message)


if __name__ == "__main__":
    graphflow.run(Talker)
