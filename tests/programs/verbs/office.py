"""Nodes with an endpoint of each kind, some of them hidden, and two that do not fit each other."""

from __future__ import annotations

from graphflow import ActionClient, Client, Group, Node, Param, Publisher, Qos, Reliability, service, subscription
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String


class Clerk(Node):
    """Adds, and could ask others."""

    desk = Group(1)
    offset = Param(0, doc="What is added to every sum.")
    minutes = Publisher(String, "minutes", Qos(depth=7, reliability=Reliability.BEST_EFFORT))
    drawer = Publisher(String, "_drawer")
    bank = Client(AddTwoInts, "/bank/add")
    rabbits = ActionClient(Fibonacci, "/fibonacci")

    @service(AddTwoInts, "~/add", group=desk)
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        if request.a < 0:
            raise ValueError("no debts")
        return AddTwoInts.Response(sum=request.a + request.b + self.offset)

    @service(AddTwoInts, "~/_add")
    async def add_in_secret(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)


class Auditor(Node):
    """Wants the clerk's minutes in another quality than there is."""

    @subscription(String, "minutes")
    async def read(self, message: String) -> None:
        self.log.info("%s", message.data)
