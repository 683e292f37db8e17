"""A node that writes numbered lines, a thousand a second, and talks at the same rate."""

from graphflow import Node, Param, Publisher, timer
from graphflow.msgs.std_msgs.msg import Int64


class Counting(Node):
    """Counts aloud."""

    rate = Param(1000.0, read_only=True)
    number = Publisher(Int64, "number")
    count = 0

    @timer(0.01)
    async def tick(self) -> None:
        for _ in range(round(self.rate / 100)):
            self.count += 1
            self.log.info("number %d", self.count)
            self.number.publish(Int64(data=self.count))
