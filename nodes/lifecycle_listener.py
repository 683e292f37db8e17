"""ROS 2's lifecycle demo: a listener that follows a lifecycle talker's transitions."""

import graphflow
from graphflow import Node, subscription
from graphflow.msgs.lifecycle_msgs.msg import TransitionEvent
from graphflow.msgs.std_msgs.msg import String


class LifecycleListener(Node):
    """Log the talker's messages and transitions."""

    node_name = "lc_listener"

    @subscription(String, "lifecycle_chatter")
    async def heard(self, message: String) -> None:
        self.log.info("data_callback: %s", message.data)

    @subscription(TransitionEvent, "/lc_talker/transition_event")
    async def changed(self, event: TransitionEvent) -> None:
        self.log.info("notify callback: from %s to %s", event.start_state.label, event.goal_state.label)


if __name__ == "__main__":
    graphflow.run(LifecycleListener)
