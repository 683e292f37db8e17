"""Programs whose main thread waits for what only spinning brings about, and nobody spins.

python -m graphflow run nobody.py HOW
"""

import sys
import threading
import time

from std_srvs.srv import Trigger

import rclpy
import rclpy.task
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node


def main():
    how = sys.argv[1]
    rclpy.init()
    node = Node("alone")
    other = Node("other")
    other.create_service(Trigger, "answer", lambda request, response: response)
    client = node.create_client(Trigger, "answer")
    client.wait_for_service()
    if how == "after":
        threading.Thread(target=client.call, args=(Trigger.Request(),)).start()
        done = rclpy.task.Future()
        other.create_timer(1.5, lambda: done.set_result(1))
        rclpy.spin_until_future_complete(other, done)
        future = client.call_async(Trigger.Request())
        both = SingleThreadedExecutor()
        both.add_node(node)
        both.add_node(other)
        both.spin_until_future_complete(future)
        print("done", flush=True)
        rclpy.shutdown()
        return
    executor = SingleThreadedExecutor()
    executor.add_node(other)
    threading.Thread(target=executor.spin, daemon=True).start()
    if how == "later":
        own = SingleThreadedExecutor()
        own.add_node(node)
        threading.Timer(1.0, own.spin).start()
    if how in ("calls", "later"):
        client.call(Trigger.Request())  # calls
    elif how == "polls":
        future = client.call_async(Trigger.Request())
        while not future.done():
            time.sleep(0.05)  # polls
    elif how == "sleeps":
        rate = node.create_rate(10)
        rate.sleep()  # sleeps
    elif how == "spins":
        future = client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(node, future)
    print("done", flush=True)
    rclpy.shutdown()


main()
