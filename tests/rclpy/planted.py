"""Programs for rclpy that cannot go on, as students write them, each with the change that its report asks for.

The line in which each is stuck has a comment with the name of its class. `Fixed...` is the same, changed.
"""

from __future__ import annotations

import concurrent.futures
import queue
import threading
import time
from contextlib import suppress
from typing import Any

from example_interfaces.action import Fibonacci
from geometry_msgs.msg import TransformStamped, Twist, Vector3
from std_msgs.msg import Header, String
from std_srvs.srv import Trigger
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformListener

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.action import ActionClient, ActionServer
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.task import Future
from rclpy.time import Time
from tests.rclpy.store import Store


class Asker(Node):
    """Asks its own service, once, as its children say."""

    threads = 1
    client_group: Any = None
    service_group: Any = None
    timer_group: Any = None

    def __init__(self) -> None:
        super().__init__("asker")
        self.done = threading.Event()
        self.fires = 0
        self.client = self.create_client(Trigger, "answer", callback_group=self.made(self.client_group))
        self.server = self.create_service(Trigger, "answer", self.answer, callback_group=self.made(self.service_group))
        self.timer = self.create_timer(0.05, self.fire, callback_group=self.made(self.timer_group))

    @staticmethod
    def made(group: Any) -> Any:
        return group() if group else None

    def answer(self, request: Any, response: Any) -> Any:
        response.success = True
        return response

    def fire(self) -> None:
        self.timer.cancel()
        self.tick()

    def tick(self) -> None:
        """What is tried."""


class Calls(Asker):
    def tick(self) -> None:
        self.client.call(Trigger.Request())  # stuck: Calls
        self.done.set()


class FixedCalls(Calls):
    def tick(self) -> None:
        future = self.client.call_async(Trigger.Request())
        future.add_done_callback(lambda _: self.done.set())


class CallsInAGroupOfItsOwn(Calls):
    threads = 2
    timer_group = MutuallyExclusiveCallbackGroup


class CallsWithThreads(Asker):
    """Two threads, and one group for all."""

    threads = 2

    def tick(self) -> None:
        self.client.call(Trigger.Request())  # stuck: CallsWithThreads
        self.done.set()


class CallsAcross(Asker):
    """The server has a group of its own, and the answer has not."""

    threads = 2
    service_group = MutuallyExclusiveCallbackGroup

    def tick(self) -> None:
        self.client.call(Trigger.Request())  # stuck: CallsAcross
        self.done.set()


class FixedCallsAcross(CallsAcross):
    timer_group = MutuallyExclusiveCallbackGroup


class CallsWithALimit(Asker):
    def tick(self) -> None:
        self.client.call(Trigger.Request(), timeout_sec=30.0)  # stuck: CallsWithALimit
        self.done.set()


class SpinsWithin(Asker):
    def tick(self) -> None:
        future = self.client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(self, future, self.executor)  # stuck: SpinsWithin
        self.done.set()


class FixedSpinsWithin(SpinsWithin):
    timer_group = MutuallyExclusiveCallbackGroup


class SpinsIntoACall(Asker):
    """What it spins blocks, and waits for the group that it holds itself."""

    def __init__(self) -> None:
        super().__init__()
        self.inner = self.create_timer(0.2, self.ask, callback_group=MutuallyExclusiveCallbackGroup())

    def tick(self) -> None:
        rclpy.spin_once(self, executor=self.executor, timeout_sec=60.0)
        self.done.set()

    def ask(self) -> None:
        self.inner.cancel()
        self.client.call(Trigger.Request())  # stuck: SpinsIntoACall


class FixedSpinsIntoACall(SpinsIntoACall):
    def ask(self) -> None:
        self.inner.cancel()
        self.client.call_async(Trigger.Request())


class SpinsOnceWithin(Asker):
    def tick(self) -> None:
        future = self.client.call_async(Trigger.Request())
        while not future.done():
            rclpy.spin_once(self, executor=self.executor)  # stuck: SpinsOnceWithin
        self.done.set()


class SpinsAndBreaks(Asker):
    def tick(self) -> None:
        future = self.client.call_async(Trigger.Request())
        while rclpy.ok():
            rclpy.spin_once(self, executor=self.executor, timeout_sec=0.2)  # stuck: SpinsAndBreaks
            if future.done():
                break
        self.done.set()


class PollsTheFuture(Asker):
    threads = 2

    def tick(self) -> None:
        self.future = self.client.call_async(Trigger.Request())
        while rclpy.ok() and not self.future.done():
            time.sleep(0.02)  # stuck: PollsTheFuture
        self.done.set()


class PollsTheResult(Asker):
    threads = 2

    def tick(self) -> None:
        future = self.client.call_async(Trigger.Request())
        while future.result() is None:
            time.sleep(0.02)  # stuck: PollsTheResult
        self.done.set()


class FixedPollsTheResult(PollsTheResult):
    timer_group = MutuallyExclusiveCallbackGroup


class WaitsForALambda(Asker):
    """What is set by a function that only an answer calls."""

    threads = 2

    def __init__(self) -> None:
        super().__init__()
        self.came = threading.Event()

    def tick(self) -> None:
        def answered(future: Any) -> None:
            self.fires += 1

        future = self.client.call_async(Trigger.Request())
        future.add_done_callback(answered)
        future.add_done_callback(lambda _: self.came.set())
        self.came.wait()  # stuck: WaitsForALambda
        self.done.set()


class FixedWaitsForALambda(WaitsForALambda):
    timer_group = MutuallyExclusiveCallbackGroup


class FixedPollsTheFuture(PollsTheFuture):
    timer_group = MutuallyExclusiveCallbackGroup


class Awaits(Asker):
    """The group is held while it is awaited."""

    def __init__(self) -> None:
        super().__init__()
        self.timer.callback = self.look

    async def look(self) -> None:
        self.timer.cancel()
        await self.client.call_async(Trigger.Request())  # stuck: Awaits
        self.done.set()


class FixedAwaits(Awaits):
    client_group = service_group = ReentrantCallbackGroup


class Sleeps(Asker):
    def tick(self) -> None:
        rate = self.create_rate(20.0)
        rate.sleep()  # stuck: Sleeps
        self.done.set()


class FixedSleeps(Sleeps):
    threads = 2


class AllThreads(Asker):
    """As many callbacks wait as there are threads."""

    threads = 2
    client_group = service_group = ReentrantCallbackGroup

    def __init__(self) -> None:
        super().__init__()
        self.other = self.create_timer(0.05, self.again, callback_group=MutuallyExclusiveCallbackGroup())

    def tick(self) -> None:
        time.sleep(0.1)
        self.client.call(Trigger.Request())  # stuck: AllThreads
        self.done.set()

    def again(self) -> None:
        self.other.cancel()
        time.sleep(0.1)
        self.client.call(Trigger.Request())


class FixedAllThreads(AllThreads):
    threads = 3


class ServesByCalling(Asker):
    """A service that asks another of the same node."""

    def __init__(self) -> None:
        super().__init__()
        self.second = self.create_service(Trigger, "second", self.on_second)
        self.starter = self.create_client(Trigger, "second", callback_group=ReentrantCallbackGroup())

    def tick(self) -> None:
        self.starter.call_async(Trigger.Request())

    def on_second(self, request: Any, response: Any) -> Any:
        self.client.call(Trigger.Request())  # stuck: ServesByCalling
        self.done.set()
        return response


class FixedServesByCalling(Asker):
    client_group = service_group = ReentrantCallbackGroup

    def __init__(self) -> None:
        super().__init__()
        self.second = self.create_service(Trigger, "second", self.on_second, callback_group=ReentrantCallbackGroup())
        self.starter = self.create_client(Trigger, "second", callback_group=ReentrantCallbackGroup())

    def tick(self) -> None:
        self.starter.call_async(Trigger.Request())

    async def on_second(self, request: Any, response: Any) -> Any:
        await self.client.call_async(Trigger.Request())
        self.done.set()
        return response


class Waits(Node):
    """Waits for what another callback brings about."""

    threads = 1
    group: Any = None

    def __init__(self) -> None:
        super().__init__("waiter")
        self.done = threading.Event()
        self.arrived = threading.Event()
        self.lock = threading.Lock()
        self.flag = False
        self.items: queue.Queue[int] = queue.Queue()
        self.future: Future[int] = Future()
        group = self.group() if self.group else None
        self.timer = self.create_timer(0.05, self.fire, callback_group=group)
        self.other = self.create_timer(0.1, self.arrive)
        self.create_subscription(String, "news", self.on_news, 10)

    def fire(self) -> None:
        self.timer.cancel()
        self.tick()

    def tick(self) -> None:
        """What is tried."""

    def arrive(self) -> None:
        """What the other does."""

    def on_news(self, message: Any) -> None:
        """Nothing has to do with it."""


class Sleeper(Waits):
    """Stands in one line until somebody from elsewhere ends that."""

    def tick(self) -> None:
        self.arrived.wait()
        self.done.set()


class WaitsForEvent(Waits):
    def tick(self) -> None:
        self.arrived.wait()  # stuck: WaitsForEvent
        self.done.set()

    def arrive(self) -> None:
        self.arrived.set()


class FixedWaitsForEvent(WaitsForEvent):
    threads = 2
    group = MutuallyExclusiveCallbackGroup


class WaitsInAGroup(Waits):
    threads = 3

    def tick(self) -> None:
        self.arrived.wait()  # stuck: WaitsInAGroup
        self.done.set()

    def arrive(self) -> None:
        self.arrived.set()


class FixedWaitsInAGroup(WaitsInAGroup):
    group = MutuallyExclusiveCallbackGroup


class PollsAFlag(Waits):
    def tick(self) -> None:
        while not self.flag:
            time.sleep(0.02)  # stuck: PollsAFlag
        self.done.set()

    def arrive(self) -> None:
        self.flag = True


class FixedPollsAFlag(PollsAFlag):
    threads = 2
    group = MutuallyExclusiveCallbackGroup


class WaitsForItsNextCall(Waits):
    threads = 2

    def __init__(self) -> None:
        super().__init__()
        self.newest = String()
        self.pub = self.create_publisher(String, "news", 10)

    def arrive(self) -> None:
        self.other.cancel()
        self.pub.publish(String(data="begin"))

    def on_news(self, message: Any) -> None:
        self.newest = message
        while self.newest.data != "end":
            time.sleep(0.02)  # stuck: WaitsForItsNextCall
        self.done.set()


class FixedWaitsForItsNextCall(WaitsForItsNextCall):
    def on_news(self, message: Any) -> None:
        self.done.set()


class PollsAtARate(PollsAFlag):
    """The rate ticks, and what it waits for never comes."""

    threads = 2

    def __init__(self) -> None:
        super().__init__()
        self.rate = self.create_rate(50.0)

    def tick(self) -> None:
        while not self.flag:
            self.rate.sleep()  # stuck: PollsAtARate
        self.done.set()


class FixedPollsAtARate(PollsAtARate):
    group = MutuallyExclusiveCallbackGroup


class HandMadeRate:
    """Sleeps until a timer of the node's wakes it."""

    def __init__(self, node: Node, period: float = 0.1) -> None:
        self.fired = False
        self.timer = node.create_timer(period, self.wake)

    def wake(self) -> None:
        self.fired = True

    def sleep(self) -> None:
        while not self.fired:
            time.sleep(0.02)  # stuck: SleepsByHand
        self.fired = False


class SleepsByHand(Waits):
    def __init__(self) -> None:
        super().__init__()
        self.rate = HandMadeRate(self)

    def tick(self) -> None:
        self.rate.sleep()
        self.done.set()


class FixedSleepsByHand(SleepsByHand):
    threads = 2
    group = MutuallyExclusiveCallbackGroup


class SleepsElsewhere(Waits):
    """The rate is that of a node which another thread spins."""

    elsewhere: Any = None

    def __init__(self) -> None:
        super().__init__()
        self.rate = HandMadeRate(self.elsewhere, 2.0)

    def tick(self) -> None:
        self.rate.sleep()
        self.done.set()

    def on_news(self, message: Any) -> None:
        self.rate.wake()


class SpinsIntoAFuture(Waits):
    """A future of its own, which another callback sets, in the executor that it spins itself."""

    threads = 2

    def tick(self) -> None:
        rclpy.spin_until_future_complete(self, self.future, self.executor)  # stuck: SpinsIntoAFuture
        self.done.set()

    def arrive(self) -> None:
        self.future.set_result(1)


class FixedSpinsIntoAFuture(SpinsIntoAFuture):
    group = MutuallyExclusiveCallbackGroup


class WaitsForAService(Waits):
    """Another callback of it offers that."""

    def tick(self) -> None:
        self.create_client(Trigger, "opened").wait_for_service()  # stuck: WaitsForAService
        self.done.set()

    def arrive(self) -> None:
        self.create_service(Trigger, "opened", lambda request, response: response)


class FixedWaitsForAService(WaitsForAService):
    threads = 2
    group = MutuallyExclusiveCallbackGroup


class PollsForAService(WaitsForAService):
    """The same by hand."""

    def tick(self) -> None:
        client = self.create_client(Trigger, "opened")
        while not client.service_is_ready():
            time.sleep(0.01)  # stuck: PollsForAService
        self.done.set()


class FixedPollsForAService(PollsForAService):
    threads = 2
    group = MutuallyExclusiveCallbackGroup


class TriesForAnAction(Waits):
    """A second at a time, and it offers that itself when it has got it."""

    def tick(self) -> None:
        client = ActionClient(self, Fibonacci, "opened")
        while rclpy.ok() and not client.wait_for_server(timeout_sec=1.0):  # stuck: TriesForAnAction
            self.get_logger().debug("not yet")
        self.actions = ActionServer(self, Fibonacci, "opened", lambda goal: Fibonacci.Result())
        self.done.set()


class FixedTriesForAnAction(TriesForAnAction):
    def tick(self) -> None:
        self.actions = ActionServer(self, Fibonacci, "opened", lambda goal: Fibonacci.Result())
        assert ActionClient(self, Fibonacci, "opened").wait_for_server()
        self.done.set()


class LooksUpATransform(Waits):
    """In the thread in which its listener would hear it."""

    def __init__(self) -> None:
        super().__init__()
        self.buffer = Buffer(node=self)
        self.listener = TransformListener(self.buffer, self)
        self.broadcaster = StaticTransformBroadcaster(self)

    def tick(self) -> None:
        self.broadcaster.sendTransform(TransformStamped(header=Header(frame_id="map"), child_frame_id="base"))
        self.buffer.lookup_transform("map", "base", Time(), Duration(seconds=30))  # stuck: LooksUpATransform
        self.done.set()


class FixedLooksUpATransform(LooksUpATransform):
    threads = 2


class TakesFromAQueue(Waits):
    def tick(self) -> None:
        self.items.get()  # stuck: TakesFromAQueue
        self.done.set()

    def arrive(self) -> None:
        self.items.put(1)


class AwaitsAFuture(Waits):
    def __init__(self) -> None:
        super().__init__()
        self.timer.callback = self.look

    async def look(self) -> None:
        self.timer.cancel()
        await self.future  # stuck: AwaitsAFuture
        self.done.set()

    def arrive(self) -> None:
        self.future.set_result(1)


class FixedAwaitsAFuture(AwaitsAFuture):
    group = ReentrantCallbackGroup


class CallsInsideALock(Asker):
    """It waits inside a lock for what needs the lock."""

    threads = 3
    client_group = service_group = MutuallyExclusiveCallbackGroup

    def __init__(self) -> None:
        self.lock = threading.Lock()
        super().__init__()

    def tick(self) -> None:
        with self.lock:
            self.client.call(Trigger.Request())  # stuck: CallsInsideALock
        self.done.set()

    def answer(self, request: Any, response: Any) -> Any:
        with self.lock:
            response.success = True
        return response


class FixedCallsInsideALock(CallsInsideALock):
    def tick(self) -> None:
        self.client.call(Trigger.Request())
        with self.lock:
            self.done.set()


class CrossesLocks(Waits):
    """Two callbacks take two locks, each the other first: one of them by `acquire`, and of another object."""

    threads = 2
    group = MutuallyExclusiveCallbackGroup

    def __init__(self) -> None:
        self.store = Store()
        super().__init__()

    def tick(self) -> None:
        with self.lock:
            time.sleep(0.3)
            with self.store.lock:  # stuck: CrossesLocks
                self.done.set()

    def arrive(self) -> None:
        self.other.cancel()
        self.store.lock.acquire()
        try:
            time.sleep(0.3)
            with self.lock:
                self.flag = True
        finally:
            self.store.lock.release()


class FixedCrossesLocks(CrossesLocks):
    def arrive(self) -> None:
        self.other.cancel()
        with self.lock, self.store.lock:
            self.flag = True


class JoinsAThread(Asker):
    """What the thread asks for is kept out by who waits for its end."""

    def tick(self) -> None:
        asking = threading.Thread(target=self.ask)
        asking.start()
        asking.join()  # stuck: JoinsAThread
        self.done.set()

    def ask(self) -> None:
        self.client.call(Trigger.Request())


class FixedJoinsAThread(JoinsAThread):
    threads = 2
    timer_group = MutuallyExclusiveCallbackGroup


class WaitsForAPool(Asker):
    """The same by way of a pool."""

    threads = 2

    def tick(self) -> None:
        with concurrent.futures.ThreadPoolExecutor() as pool:
            pool.submit(self.client.call, Trigger.Request()).result()  # stuck: WaitsForAPool
        self.done.set()


class FixedWaitsForAPool(WaitsForAPool):
    timer_group = MutuallyExclusiveCallbackGroup


class WaitsForWhatFollows(Asker):
    """What sets it is called when the answer has been taken."""

    threads = 2

    def __init__(self) -> None:
        self.came = threading.Event()
        super().__init__()

    def tick(self) -> None:
        self.client.call_async(Trigger.Request()).add_done_callback(self.on_answer)
        self.came.wait()  # stuck: WaitsForWhatFollows
        self.done.set()

    def on_answer(self, future: Any) -> None:
        self.came.set()


class FixedWaitsForWhatFollows(WaitsForWhatFollows):
    timer_group = MutuallyExclusiveCallbackGroup


class PollsWhatAGoalSets(Node):
    """What sets it follows what follows, and is not asked for yet."""

    threads = 1
    group: Any = None

    def __init__(self) -> None:
        super().__init__("actor")
        self.done = threading.Event()
        self.finished = False
        self.server = ActionServer(self, Fibonacci, "count", self.execute)
        self.client = ActionClient(self, Fibonacci, "count")
        self.timer = self.create_timer(0.05, self.tick, callback_group=self.group() if self.group else None)

    def execute(self, goal: Any) -> Any:
        goal.succeed()
        return Fibonacci.Result()

    def tick(self) -> None:
        self.timer.cancel()
        self.sending = self.client.send_goal_async(Fibonacci.Goal(order=3))
        self.sending.add_done_callback(self.accepted)
        while not self.finished and rclpy.ok():
            time.sleep(0.02)  # stuck: PollsWhatAGoalSets
        self.done.set()

    def accepted(self, future: Any) -> None:
        future.result().get_result_async().add_done_callback(self.on_result)

    def on_result(self, future: Any) -> None:
        self.finished = True


class FixedPollsWhatAGoalSets(PollsWhatAGoalSets):
    threads = 2
    group = MutuallyExclusiveCallbackGroup


class Navigator:
    """Says whether its goal has ended, as that of Nav2 does."""

    def __init__(self, node: Node) -> None:
        self.client = ActionClient(node, Fibonacci, "count")
        self.result: Any = None

    def go(self) -> None:
        self.client.send_goal_async(Fibonacci.Goal(order=3)).add_done_callback(self.accepted)

    def accepted(self, future: Any) -> None:
        future.result().get_result_async().add_done_callback(self.on_result)

    def on_result(self, future: Any) -> None:
        self.result = future.result().result

    def is_task_complete(self) -> bool:
        return self.result is not None


class PollsANavigator(PollsWhatAGoalSets):
    def __init__(self) -> None:
        super().__init__()
        self.navigator = Navigator(self)

    def tick(self) -> None:
        self.timer.cancel()
        self.navigator.go()
        while not self.navigator.is_task_complete():
            time.sleep(0.02)  # stuck: PollsANavigator
        self.done.set()


class FixedPollsANavigator(PollsANavigator):
    threads = 2
    group = MutuallyExclusiveCallbackGroup


class DrivesThere(Waits):
    """Its loop sends messages, whose fields are called as what it waits for."""

    def __init__(self) -> None:
        super().__init__()
        self.x = 0.0
        self.command = Twist()
        self.driving = self.create_publisher(Twist, "drive", 1)
        self.seen = self.create_subscription(Vector3, "odometry", self.on_odometry, 10)

    def on_odometry(self, message: Any) -> None:
        self.x = message.x

    def tick(self) -> None:
        goal = Vector3()
        goal.x = 0.5
        self.command.linear.x = 0.2
        while rclpy.ok():
            self.driving.publish(self.command)
            if self.x >= 0.5:
                break
            time.sleep(0.02)  # stuck: DrivesThere
        self.done.set()

    def arrive(self) -> None:
        self.seen.callback(Vector3(x=1.0))


class FixedDrivesThere(DrivesThere):
    threads = 2
    group = MutuallyExclusiveCallbackGroup


class SendsAGoal(Node):
    """It waits for a goal that it executes itself."""

    threads = 1

    def __init__(self) -> None:
        super().__init__("actor")
        self.done = threading.Event()
        self.server = ActionServer(self, Fibonacci, "count", self.execute)
        self.client = ActionClient(self, Fibonacci, "count")
        self.timer = self.create_timer(0.05, self.tick)

    def execute(self, goal: Any) -> Any:
        goal.succeed()
        return Fibonacci.Result()

    def tick(self) -> None:
        self.timer.cancel()
        self.client.send_goal(Fibonacci.Goal(order=3))  # stuck: SendsAGoal
        self.done.set()


class FixedSendsAGoal(SendsAGoal):
    def tick(self) -> None:
        self.timer.cancel()
        self.client.send_goal_async(Fibonacci.Goal(order=3)).add_done_callback(self.answered)

    def answered(self, future: Any) -> None:
        future.result().get_result_async().add_done_callback(lambda _: self.done.set())


class WaitsForAResult(Asker):
    """The goal that it waits for asks a service that it keeps out."""

    threads = 3
    client_group = MutuallyExclusiveCallbackGroup

    def __init__(self) -> None:
        super().__init__()
        free = ReentrantCallbackGroup()
        self.actions = ActionServer(self, Fibonacci, "count", self.execute, callback_group=free)
        self.goals = ActionClient(self, Fibonacci, "count", callback_group=free)

    def tick(self) -> None:
        self.goals.send_goal(Fibonacci.Goal(order=3))  # stuck: WaitsForAResult
        self.done.set()

    def execute(self, goal: Any) -> Any:
        self.client.call(Trigger.Request())
        goal.succeed()
        return Fibonacci.Result()


class FixedWaitsForAResult(WaitsForAResult):
    timer_group = MutuallyExclusiveCallbackGroup


class CallsInAGoal(Asker):
    """The body of a goal asks a service in the only thread."""

    def __init__(self) -> None:
        super().__init__()
        self.actions = ActionServer(self, Fibonacci, "count", self.execute)
        self.starter = ActionClient(self, Fibonacci, "count")

    def tick(self) -> None:
        self.starter.send_goal_async(Fibonacci.Goal(order=3))

    def execute(self, goal: Any) -> Any:
        self.client.call(Trigger.Request())  # stuck: CallsInAGoal
        goal.succeed()
        self.done.set()
        return Fibonacci.Result()


class FixedCallsInAGoal(CallsInAGoal):
    threads = 2


class AsksInsideALock(Asker):
    """A thread of the program's own asks, and holds what the answer needs."""

    def __init__(self) -> None:
        super().__init__()
        self.lock = threading.Lock()

    def answer(self, request: Any, response: Any) -> Any:
        with self.lock:
            return response

    def ask(self) -> None:
        with self.lock, suppress(RCLError, TimeoutError):
            self.client.call(Trigger.Request())  # stuck: AsksInsideALock


OWN = "make fire of /asker with callback_group=MutuallyExclusiveCallbackGroup()"

PLANTED: list[tuple[type[Any], type[Any], str]] = [
    (Calls, FixedCalls, "future = client.call_async(request), then future.add_done_callback(...)"),
    (Calls, CallsInAGroupOfItsOwn, OWN),
    (CallsWithThreads, CallsInAGroupOfItsOwn, OWN),
    (
        CallsAcross,
        FixedCallsAcross,
        OWN,
    ),
    (CallsWithALimit, FixedCalls, "then future.add_done_callback(...)"),
    (SpinsWithin, FixedSpinsWithin, OWN),
    (SpinsIntoACall, FixedSpinsIntoACall, "future = client.call_async(request), then future.add_done_callback(...)"),
    (SpinsOnceWithin, FixedSpinsWithin, OWN),
    (SpinsAndBreaks, FixedSpinsWithin, OWN),
    (PollsTheFuture, FixedPollsTheFuture, OWN),
    (PollsTheResult, FixedPollsTheResult, OWN),
    (WaitsForALambda, FixedWaitsForALambda, OWN),
    (PollsAtARate, FixedPollsAtARate, "make fire of /waiter with callback_group=MutuallyExclusiveCallbackGroup()"),
    (WaitsForItsNextCall, FixedWaitsForItsNextCall, "This ends it: return from on_news instead of waiting for"),
    (SleepsByHand, FixedSleepsByHand, "wake, which sets it, is kept out"),
    (PollsANavigator, FixedPollsANavigator, "what follows the answer of /count, which sets it, is kept out"),
    (
        SpinsIntoAFuture,
        FixedSpinsIntoAFuture,
        "make fire of /waiter with callback_group=MutuallyExclusiveCallbackGroup()",
    ),
    (Awaits, FixedAwaits, "callback_group=ReentrantCallbackGroup()"),
    (Sleeps, FixedSleeps, "spin with MultiThreadedExecutor(num_threads=2)"),
    (AllThreads, FixedAllThreads, "spin with MultiThreadedExecutor(num_threads=3)"),
    (ServesByCalling, FixedServesByCalling, "make on_second async def, and await client.call_async(request),"),
    (WaitsForEvent, FixedWaitsForEvent, "spin with MultiThreadedExecutor(num_threads=2)"),
    (WaitsInAGroup, FixedWaitsInAGroup, "make fire of /waiter with callback_group=MutuallyExclusiveCallbackGroup()"),
    (PollsForAService, FixedPollsForAService, "return from fire instead of waiting for service /opened in planted.py:"),
    (WaitsForAService, FixedWaitsForAService, "return from fire instead of waiting for service /opened in planted.py:"),
    (TriesForAnAction, FixedTriesForAnAction, "make action /opened before planted.py:"),
    (LooksUpATransform, FixedLooksUpATransform, "spin with MultiThreadedExecutor(num_threads=2)"),
    (PollsAFlag, FixedPollsAFlag, "spin with MultiThreadedExecutor(num_threads=2)"),
    (TakesFromAQueue, FixedWaitsForEvent, "spin with MultiThreadedExecutor(num_threads=2)"),
    (AwaitsAFuture, FixedAwaitsAFuture, "callback_group=ReentrantCallbackGroup()"),
    (CallsInsideALock, FixedCallsInsideALock, "to where it does not hold self.lock"),
    (JoinsAThread, FixedJoinsAThread, OWN),
    (WaitsForAPool, FixedWaitsForAPool, OWN),
    (CrossesLocks, FixedCrossesLocks, "in the same order everywhere"),
    (WaitsForWhatFollows, FixedWaitsForWhatFollows, OWN),
    (PollsWhatAGoalSets, FixedPollsWhatAGoalSets, "make tick of /actor with callback_group=Mutually"),
    (DrivesThere, FixedDrivesThere, "make fire of /waiter with callback_group=MutuallyExclusiveCallbackGroup(),"),
    (SendsAGoal, FixedSendsAGoal, "future = client.send_goal_async(goal), then future.add_done_callback(...)"),
    (WaitsForAResult, FixedWaitsForAResult, OWN),
    (CallsInAGoal, FixedCallsInAGoal, "spin with MultiThreadedExecutor(num_threads=2)"),
]
"""What is stuck, the same with the change applied, and how the report words that change."""
