"""Nodes for the views to show."""

from __future__ import annotations

from graphflow import Group, Node, Param, Publisher, action, service, subscription
from graphflow.msgs.base import ServerGoalHandle
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.msgs.turtlesim.msg import Pose

PICTURE = """<svg><g>
<polyline points="0.5,499.5 250.0,250.0 499.5,0.5" stroke="#ff8000" stroke-width="3"/>
</g></svg>"""


class Talker(Node):
    """Publishes, serves, and offers an action."""

    node_name = "talker"
    rate = Param(2.0, unit="Hz", gt=0.0, le=100.0, doc="How often.")
    shout = Param(False, doc="Whether loudly.")
    serial = Param("A1", read_only=True)
    chatter = Publisher(String, "chatter")
    speed = Publisher(Twist, "speed")
    pose = Publisher(Pose, "/turtle1/pose")
    motion = Group(1)

    @service(AddTwoInts, "add", group=motion)
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    @service(Trigger, "snapshot")
    async def snapshot(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True, message=PICTURE)

    @action(Fibonacci, "fibonacci")
    async def fibonacci(
        self, goal: ServerGoalHandle[Fibonacci.Goal, Fibonacci.Result, Fibonacci.Feedback]
    ) -> Fibonacci.Result:
        goal.feedback(Fibonacci.Feedback(sequence=[0, 1, 1]))
        await self.clock.sleep(5.0)
        return Fibonacci.Result(sequence=[0, 1, 1, 2])


class Listener(Node):
    """Subscribes."""

    node_name = "listener"

    @subscription(String, "chatter")
    async def heard(self, message: String) -> None:
        self.log.info("heard %s", message.data)

    @subscription(Twist, "/turtle1/cmd_vel")
    async def driven(self, message: Twist) -> None:
        self.log.info("driven")
