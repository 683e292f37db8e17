"""The listener of the ROS 2 tutorials: a subscription."""

import graphflow
from graphflow import Node, subscription
from graphflow.msgs.std_msgs.msg import String


class Listener(Node):
    """Log everything published on `chatter`."""

    @subscription(String, "chatter")
    async def heard(self, message: String) -> None:
        self.log.info("I heard: [%s]", message.data)


if __name__ == "__main__":
    graphflow.run(Listener)
