"""A node of graphflow's own in a ring with one of rclpy's: asked, it asks /a."""

from graphflow import Client, Group, Node, service
from graphflow.msgs.std_srvs.srv import Trigger


class B(Node):
    node_name = "b"
    default_group = Group(1)
    client = Client(Trigger, "/a/ask")

    @service(Trigger, "/b/ask")
    async def ask(self, request: Trigger.Request) -> Trigger.Response:
        return await self.client.call(request, timeout=None)  # native ask
