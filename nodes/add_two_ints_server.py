"""Adds two integers."""

import graphflow
from graphflow import Node, service
from graphflow.msgs.example_interfaces.srv import AddTwoInts


class AddTwoIntsServer(Node):
    """Offer the service of ROS 2's first lesson on services."""

    @service(AddTwoInts, "add_two_ints")
    def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        self.log.info("Incoming request\na: %d b: %d", request.a, request.b)
        return AddTwoInts.Response(sum=request.a + request.b)


if __name__ == "__main__":
    graphflow.run(AddTwoIntsServer)
