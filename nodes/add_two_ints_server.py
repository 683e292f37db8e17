"""A service server that adds two integers."""

import graphflow
from graphflow import Node, service
from graphflow.msgs.example_interfaces.srv import AddTwoInts


class AddTwoIntsServer(Node):
    """Offer the service from ROS 2's first tutorial on services."""

    @service(AddTwoInts, "add_two_ints")
    def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        self.log.info("Incoming request\na: %d b: %d", request.a, request.b)
        return AddTwoInts.Response(sum=request.a + request.b)


if __name__ == "__main__":
    graphflow.run(AddTwoIntsServer)
