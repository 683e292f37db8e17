"""Code written for rclpy beside nodes of graphflow's own: a Twist there and back, and service calls.

rclpy's callbacks run in threads, so that a message passes from Zenoh's thread to theirs; and their messages are
classes of their own, with fields that are checked.

Goal: there and back at most 2 times what nodes of graphflow's own take.
"""

from __future__ import annotations

import statistics
import sys
import threading
import time
from collections.abc import Callable
from functools import partial
from multiprocessing.connection import Connection
from typing import Any

from benchmarks.calls import CALLS, node_caller, node_server
from benchmarks.peers import LIMIT, Peer, finish, rendezvous, stay
from benchmarks.round_trip import PINGS, keep, node_pinger, node_ponger, raw_pinger, raw_ponger
from benchmarks.rounds import compare, goal
from graphflow.rclpy import enabling


def rclpy_ponger(pipe: Connection) -> None:
    """Answer on /rclpy/pong what comes on /rclpy/ping, and requests on /rclpy/add."""
    enabling.here()
    from example_interfaces.srv import AddTwoInts
    from geometry_msgs.msg import Twist

    import rclpy
    from rclpy.node import Node

    rclpy.init(args=["ponger"])
    node = Node("rclpy_ponger", enable_rosout=False)
    pong = node.create_publisher(Twist, "/rclpy/pong", 10)
    node.create_subscription(Twist, "/rclpy/ping", pong.publish, 10)

    def add(request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        return response

    node.create_service(AddTwoInts, "/rclpy/add", add)
    threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
    stay(pipe)


class RclpyPinger:
    """Measures rounds, and calls, of a node that a thread of its own spins."""

    def __init__(self) -> None:
        enabling.here()
        from example_interfaces.srv import AddTwoInts
        from geometry_msgs.msg import Twist

        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node

        rclpy.init(args=["pinger"])
        self.node = Node("rclpy_pinger", enable_rosout=False)
        self.message, self.request = Twist(), AddTwoInts.Request(a=2, b=3)
        self.publisher = self.node.create_publisher(Twist, "/rclpy/ping", 10)
        self.node.create_subscription(Twist, "/rclpy/pong", self.heard, 10)
        self.client = self.node.create_client(AddTwoInts, "/rclpy/add")
        self.times: list[int] = []
        self.sent = 0
        self.done = threading.Event()
        executor = SingleThreadedExecutor()
        executor.add_node(self.node)
        threading.Thread(target=executor.spin, daemon=True).start()
        assert self.client.wait_for_service(LIMIT)
        deadline = time.monotonic() + LIMIT
        while not self.publisher.get_subscription_count():
            assert time.monotonic() < deadline
            time.sleep(0.005)

    def heard(self, _: Any) -> None:
        self.times.append(time.perf_counter_ns() - self.sent)
        if len(self.times) >= PINGS:
            self.done.set()
        else:
            self.ping()

    def ping(self) -> None:
        self.sent = time.perf_counter_ns()
        self.publisher.publish(self.message)

    def rounds(self) -> float:
        """Microseconds there and back."""
        self.times.clear()
        self.done.clear()
        self.ping()
        assert self.done.wait(LIMIT), "a ping was lost"
        return statistics.median(self.times) / 1000

    def calls(self) -> float:
        """Microseconds a call that blocks."""
        began = time.perf_counter()
        for _ in range(CALLS):
            self.client.call(self.request)
        return (time.perf_counter() - began) / CALLS * 1e6


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 11
    keep.append(rendezvous())
    keep.extend([Peer(raw_ponger), Peer(node_ponger, "asyncio"), Peer(node_server, "asyncio"), Peer(rclpy_ponger)])
    rclpy = RclpyPinger()
    print("\nthere and back: microseconds")
    pings: dict[str, Callable[[], float]] = {
        "nodes, asyncio": node_pinger("asyncio"),
        "raw zenoh": raw_pinger(),
        "rclpy": rclpy.rounds,
    }
    found = compare(pings, rounds, "us", "nodes, asyncio")
    goal("there and back, rclpy / nodes", found["rclpy"][1], 2.0)
    print("\none caller: microseconds a call")
    calls: dict[str, Callable[[], float]] = {
        "nodes, asyncio": partial(node_caller("asyncio"), 1),
        "rclpy, which blocks": rclpy.calls,
    }
    compare(calls, rounds, "us", "nodes, asyncio")
    finish()


if __name__ == "__main__":
    main()
