"""One process of a ring: node NAME, whose callback asks node ASKED.

    python -m graphflow run ring.py NAME ASKED HOW [starts]

What starts asks first, from a timer; the others, asked, ask on. HOW is `calls` (and blocks), `awaits` (in the default
group), `pools` (blocks, in a pool of threads), `acts` (sends a goal and blocks). With the remedies of their reports:
`later` does not block, `apart` blocks with groups of its own, `goals` sends goals without blocking.
"""

import sys

from example_interfaces.action import Fibonacci
from std_srvs.srv import Trigger

import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node


class Member(Node):
    def __init__(self, name, asked, how, starts):
        super().__init__(name)
        self.how, self.starts = how, starts
        group = ReentrantCallbackGroup() if how == "later" else None
        own = MutuallyExclusiveCallbackGroup() if how == "apart" else group  # of what waits
        on = {"awaits": self.on_ask_async, "later": self.on_ask_async}.get(how, self.on_ask)
        self.service = self.create_service(Trigger, f"/{name}/ask", on, callback_group=group if starts else own)
        self.action = ActionServer(self, Fibonacci, f"/{name}/act", self.on_goal)
        self.client = self.create_client(Trigger, f"/{asked}/ask", callback_group=group)
        self.goals = ActionClient(self, Fibonacci, f"/{asked}/act")
        if starts:
            wanted = self.goals.wait_for_server if how in ("acts", "goals") else self.client.wait_for_service
            wanted()
            on = {"awaits": self.on_timer_async}.get(how, self.on_timer)
            self.timer = self.create_timer(0.3, on, callback_group=own)
            if how in ("later", "goals"):
                self.timer.callback = self.on_timer_later

    def on_timer(self):
        self.timer.cancel()
        if self.how == "acts":
            self.goals.send_goal(Fibonacci.Goal())  # goal
        else:
            self.client.call(Trigger.Request())  # timer
        self.get_logger().info("all the way round")

    async def on_timer_async(self):
        self.timer.cancel()
        await self.client.call_async(Trigger.Request())  # async timer
        self.get_logger().info("all the way round")

    def on_timer_later(self):
        self.timer.cancel()
        if self.how == "goals":
            future = self.goals.send_goal_async(Fibonacci.Goal())
        else:
            future = self.client.call_async(Trigger.Request())
        future.add_done_callback(lambda _: self.get_logger().info("all the way round"))

    def on_ask(self, request, response):
        if not self.starts:
            self.client.call(Trigger.Request())  # ask
        return response

    async def on_ask_async(self, request, response):
        if self.how == "awaits" and not self.starts:
            await self.client.call_async(Trigger.Request())  # async ask
        return response

    def on_goal(self, goal):
        if self.how == "acts":
            self.client.call(Trigger.Request())  # act
        goal.succeed()
        return Fibonacci.Result()


def main():
    name, asked, how = sys.argv[1:4]
    rclpy.init()
    node = Member(name, asked, how, starts=len(sys.argv) > 4)
    pools = {"pools": 4, "apart": 2}
    executor = MultiThreadedExecutor(pools[how]) if how in pools else SingleThreadedExecutor()
    executor.add_node(node)
    print("up", flush=True)
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()


main()
