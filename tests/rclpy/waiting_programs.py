"""Programs for rclpy that block, for longer than any look, and are right: nobody may call them stuck.

Each is a way to wait, tried in several arrangements of groups, executors and threads.
"""

from __future__ import annotations

import concurrent.futures
import queue
import threading
import time
from typing import Any

from example_interfaces.action import Fibonacci
from std_srvs.srv import Trigger

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.action import ActionClient, ActionServer
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from tests.rclpy.store import LONG, Store


class Server(Node):
    """Takes its time."""

    def __init__(self, group: Any) -> None:
        super().__init__("server")
        self.create_service(Trigger, "answer", self.answer, callback_group=group())
        self.actions = ActionServer(self, Fibonacci, "count", self.execute, callback_group=group())

    def answer(self, request: Any, response: Any) -> Any:
        time.sleep(LONG)
        return response

    def execute(self, goal: Any) -> Any:
        time.sleep(LONG)
        goal.succeed()
        return Fibonacci.Result()


class Waiter(Node):
    """Waits. Its source shows all that is done to what it waits for."""

    way: Any
    """The method in which it does."""

    def __init__(self, group: Any, *, starts_itself: bool) -> None:
        super().__init__("waiter")
        self.done = threading.Event()
        self.arrived = threading.Event()
        self.lock = threading.Lock()
        self.condition = threading.Condition()
        self.items: queue.Queue[int] = queue.Queue()
        self.flag = self.finished = False
        self.came = threading.Event()
        self.store = Store()
        self.future: Future[int] = Future()
        self.promise: concurrent.futures.Future[int] = concurrent.futures.Future()
        self.client = self.create_client(Trigger, "answer", callback_group=group())
        self.absent = self.create_client(Trigger, "later", callback_group=group())
        self.goals = ActionClient(self, Fibonacci, "count", callback_group=group())
        self.created = time.monotonic()
        self.other = self.create_timer(LONG, self.arrive, callback_group=group())
        self.locks = self.create_timer(0.05, self.keep_lock, callback_group=group())
        self.timer = self.create_timer(0.05, self.fire, callback_group=group()) if starts_itself else None

    def arrive(self) -> None:
        self.other.cancel()
        self.arrived.set()
        self.items.put(1)
        self.flag = True
        self.future.set_result(1)
        self.promise.set_result(1)
        with self.condition:
            self.condition.notify_all()
        self.create_service(Trigger, "later", lambda request, response: response)

    def keep_lock(self) -> None:
        self.locks.cancel()
        with self.lock:
            time.sleep(LONG)

    def fire(self) -> Any:
        self.timer.cancel()  # type: ignore[union-attr]
        self.go()

    def go(self) -> None:
        """Wait, and be done."""
        self.way()
        self.done.set()

    def answered(self, future: Any) -> None:
        time.sleep(LONG)
        self.came.set()

    def accepted(self, future: Any) -> None:
        future.result().get_result_async().add_done_callback(self.ended)

    def ended(self, future: Any) -> None:
        time.sleep(LONG)
        self.finished = True

    # ways

    def call(self) -> None:
        self.client.call(Trigger.Request())

    def call_twice(self) -> None:
        self.client.call(Trigger.Request())
        self.client.call(Trigger.Request())

    def call_in_vain(self) -> None:
        assert self.client.call(Trigger.Request(), timeout_sec=LONG / 2) is None

    def poll(self) -> None:
        future = self.client.call_async(Trigger.Request())
        while not future.done():
            time.sleep(0.01)

    def poll_and_break(self) -> None:
        future = self.client.call_async(Trigger.Request())
        while rclpy.ok():
            time.sleep(0.01)
            if future.done():
                break

    def event(self) -> None:
        self.arrived.wait()

    def event_of_callback(self) -> None:
        came = threading.Event()
        self.client.call_async(Trigger.Request()).add_done_callback(lambda _: came.set())
        came.wait()

    def event_of_answer(self) -> None:
        self.client.call_async(Trigger.Request()).add_done_callback(self.answered)
        self.came.wait()

    def flag_of_result(self) -> None:
        self.goals.wait_for_server()
        self.sending = self.goals.send_goal_async(Fibonacci.Goal(order=1))
        self.sending.add_done_callback(self.accepted)
        while rclpy.ok() and not self.finished:
            time.sleep(0.01)

    def join(self) -> None:
        asking = threading.Thread(target=self.call)
        asking.start()
        asking.join()

    def pool(self) -> None:
        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            slow = [pool.submit(time.sleep, LONG), pool.submit(self.call)]
            concurrent.futures.wait(slow)
            slow[1].result()

    def take(self) -> None:
        self.items.get()

    def poll_flag(self) -> None:
        while not self.flag:
            time.sleep(0.01)

    def poll_future(self) -> None:
        while not self.future.done():
            time.sleep(0.01)

    def promised(self) -> None:
        self.promise.result()

    def notified(self) -> None:
        with self.condition:
            self.condition.wait(LONG * 3)

    def lock_wait(self) -> None:
        time.sleep(0.1)
        with self.lock:
            self.flag = True

    def lock_of_another(self) -> None:
        thread = threading.Thread(target=self.store.fill)
        with self.lock:  # while it waits for a lock of the other's
            thread.start()
            time.sleep(0.1)
            self.store.fill()
        thread.join()

    def sleep(self) -> None:
        time.sleep(LONG)

    def rate(self) -> None:
        rate = self.create_rate(4.0)
        for _ in range(3):
            rate.sleep()

    def goal(self) -> None:
        self.goals.wait_for_server()
        self.goals.send_goal(Fibonacci.Goal(order=1))

    def service_to_come(self) -> None:
        assert self.absent.wait_for_service(10.0)

    def work(self) -> None:
        until = time.monotonic() + LONG
        while time.monotonic() < until:
            sum(range(1000))


class Awaiter(Waiter):
    """Waits in coroutines."""

    def fire(self) -> Any:
        return self.coroutine()

    async def coroutine(self) -> None:
        if self.timer is not None:
            self.timer.cancel()
        await self.way()
        self.done.set()

    async def await_call(self) -> None:
        await self.client.call_async(Trigger.Request())

    async def await_future(self) -> None:
        await self.future

    async def await_goal(self) -> None:
        handle = await self.goals.send_goal_async(Fibonacci.Goal(order=1))
        await handle.get_result_async()


class CoroutineTimer(Awaiter):
    """Its timer's callback is a coroutine function, as executors look for."""

    def __init__(self, group: Any, *, starts_itself: bool) -> None:
        super().__init__(group, starts_itself=starts_itself)
        self.timer.callback = self.coroutine  # type: ignore[union-attr]


WAYS = [name for name, value in vars(Waiter).items() if callable(value) and not name.startswith("_")]
WAYS = WAYS[WAYS.index("call") :]
AWAITS = [name for name in vars(Awaiter) if name.startswith("await_")]
ARRANGEMENTS = ["groups", "reentrant", "executors", "worker"]


class Running:
    """A program in one arrangement, in threads of its own."""

    def __init__(self, way: str, arrangement: str) -> None:
        rclpy.init()
        group: Any = ReentrantCallbackGroup if arrangement == "reentrant" else MutuallyExclusiveCallbackGroup
        kind = CoroutineTimer if way in AWAITS else Waiter
        self.node = kind(group, starts_itself=arrangement != "worker")
        self.node.way = getattr(self.node, way)
        self.server = Server(group)
        executors: list[Executor] = [MultiThreadedExecutor(6)]
        if arrangement == "executors":
            executors.append(SingleThreadedExecutor())
        if arrangement == "worker":
            executors = [SingleThreadedExecutor(), SingleThreadedExecutor(), SingleThreadedExecutor()]
        executors[0].add_node(self.node)
        executors[-1].add_node(self.server)
        works = [executor.spin for executor in executors]
        if arrangement == "worker":
            works.append(self.node.go)
        self.threads = [threading.Thread(target=self._run, args=(work,)) for work in works]
        for thread in self.threads:
            thread.start()

    @staticmethod
    def _run(work: Any) -> None:
        try:
            work()
        except (rclpy.executors.ExternalShutdownException, RCLError):
            return

    def end(self) -> None:
        rclpy.try_shutdown()
        for thread in self.threads:
            thread.join(20.0)
            assert not thread.is_alive()
