"""A node's transforms: looked up, waited for, sent and warned of."""

from __future__ import annotations

import asyncio
import logging
import math
from typing import Any

import pytest

from graphflow import Durability, Node, Qos, Time, service, task, timer
from graphflow.errors import DeclarationError, ExtrapolationError, TransformError, UnconnectedFrames, UnknownFrame
from graphflow.msgs.geometry_msgs.msg import PointStamped
from graphflow.msgs.std_msgs.msg import Header
from graphflow.msgs.std_srvs.srv import Trigger
from graphflow.msgs.tf2_msgs.msg import TFMessage
from graphflow.runtime.mistakes.errors.attribute_errors import better_text
from graphflow.testing import Graph
from graphflow.tf import Transform, Transforms
from tests.cases import slow

LATCHED = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)


class Listener(Node):
    tf = Transforms()


class Odometry(Node):
    """A robot that drives at 1 m/s; it sends where it is ten times a second."""

    tf = Transforms(listen=False)
    x = 0.0

    @timer(0.1)
    def step(self) -> None:
        self.x += 0.1
        self.tf.send(Transform.of("odom", "base_link", (self.x, 0.0, 0.0)))


class Laser(Node):
    tf = Transforms(listen=False)

    async def on_start(self) -> None:
        self.tf.send_static(Transform.of("base_link", "laser", (0.0, 0.0, 0.2), rpy=(0.0, 0.0, math.pi)))


def warnings(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [r.getMessage() for r in caplog.records if r.levelno == logging.WARNING]


@slow
async def test_lookups(graph: Graph) -> None:
    """A chain of moving and static frames, at the latest time, and at one between two transforms."""
    listener = Listener()
    await graph.start(listener, Odometry(), Laser())
    await graph.clock.advance(1.0)

    latest = listener.tf.get("odom", "laser")
    assert latest.translation == pytest.approx((1.0, 0.0, 0.2))
    assert latest.yaw == pytest.approx(math.pi)
    assert (latest.parent, latest.child) == ("odom", "laser")
    assert latest.stamp == graph.clock.now()
    earlier = listener.tf.get("odom", "base_link", Time(graph.clock.time_ns() - 250_000_000))
    assert earlier.translation == pytest.approx((0.75, 0.0, 0.0))
    assert listener.tf.frames == ["base_link", "laser", "odom"]
    assert (listener.tf.parent("laser"), listener.tf.parent("odom")) == ("base_link", None)


async def test_between_two_times(graph: Graph) -> None:
    """The robot now, as seen from where it was half a second ago."""
    listener = Listener()
    await graph.start(listener, Odometry())
    await graph.clock.advance(1.0)
    now = graph.clock.time_ns()
    found = listener.tf.get("base_link", "base_link", Time(now), fixed="odom", target_at=Time(now - 500_000_000))
    assert found.translation == pytest.approx((0.5, 0.0, 0.0))


async def test_waiting(graph: Graph) -> None:
    """A lookup waits for its frames, for a connection, and for its time."""
    listener = Listener()
    await graph.start(listener)
    waiting = asyncio.ensure_future(listener.tf.lookup("odom", "laser", timeout=5.0))
    await graph.settle()
    await graph.start(Laser())
    await graph.settle()
    assert not waiting.done()
    await graph.start(Odometry())
    await graph.clock.advance(0.1)
    assert (await waiting).translation == pytest.approx((0.1, 0.0, 0.2))

    soon = Time(graph.clock.time_ns() + 150_000_000)
    waiting = asyncio.ensure_future(listener.tf.lookup("odom", "base_link", soon))
    await graph.clock.advance(0.1)
    assert not waiting.done()
    await graph.clock.advance(0.1)
    assert (await waiting).translation == pytest.approx((0.25, 0.0, 0.0))
    assert listener.tf._waits == {}


async def test_a_lookup_in_on_start(graph: Graph) -> None:
    """Transforms arrive while a node starts."""

    class Needs(Node):
        tf = Transforms()

        async def on_start(self) -> None:
            self.found = await self.tf.lookup("base_link", "laser")

    await graph.start(Laser())
    needs = Needs()
    await graph.start(needs)
    assert needs.found.translation == (0.0, 0.0, 0.2)


async def test_a_group_of_the_node_keeps_none_out(graph: Graph) -> None:
    """A handler that waits for a transform holds a slot of its group; the transform arrives all the same."""
    from graphflow import Group

    class Serving(Node):
        default_group = Group(1)
        tf = Transforms()

        @service(Trigger, "where")
        async def where(self, request: Trigger.Request) -> Trigger.Response:
            found = await self.tf.lookup("odom", "base_link")
            return Trigger.Response(success=True, message=f"{found.translation[0]:.1f}")

    await graph.start(Serving(), Odometry())
    answer = asyncio.ensure_future(graph.call(Trigger, "/where", Trigger.Request()))
    await graph.clock.advance(0.1)
    assert (await answer).message == "0.1"


async def test_a_time_that_is_no_longer_kept(graph: Graph) -> None:
    """The error names the length of the history, and the option for more."""
    listener = Listener()
    await graph.start(listener, Odometry())
    await graph.clock.advance(12.0)
    with pytest.raises(ExtrapolationError, match=r"kept is .* s newer; the node keeps 10\.00 s, more with Transforms"):
        listener.tf.get("odom", "base_link", Time(graph.clock.time_ns() - 11 * 10**9))


async def test_errors_name_the_publisher(graph: Graph) -> None:
    """And its rate, and that it has stopped or ended."""
    listener, odometry = Listener(), Odometry()
    await graph.start(listener)
    with pytest.raises(UnknownFrame, match=r"no frame is known so far; no node publishes /tf or /tf_static$"):
        listener.tf.get("odom", "base_link")
    await graph.start(odometry)
    await graph.clock.advance(1.0)
    ahead = Time(graph.clock.time_ns() + 800_000_000)
    with pytest.raises(ExtrapolationError, match=r"0\.80 s older; /odometry publishes it at 10 Hz$"):
        listener.tf.get("odom", "base_link", ahead)
    with pytest.raises(ExtrapolationError, match=r"kept is .* s newer; none from before has come"):
        listener.tf.get("odom", "base_link", Time(graph.clock.time_ns() - 5 * 10**9))
    listener.create_publisher(TFMessage, "/tf", 10).publish(
        TFMessage(
            transforms=[Transform.of("base_link", "laser", stamp=Time(graph.clock.time_ns() - 2 * 10**9)).to_msg()]
        )
    )
    await graph.settle()
    with pytest.raises(
        ExtrapolationError, match=r"; base_link -> laser was sent once, at that time: send it again, or"
    ):
        listener.tf.get("odom", "laser")
    with pytest.raises(ExtrapolationError, match="use_sim_time on both nodes"):
        listener.tf.get("odom", "base_link", Time(1))
    with pytest.raises(UnconnectedFrames, match=r"odom is the root of a tree, .* \(waited 0\.5 s\)"):
        await graph.start(Laser(remap=["/tf_static:=/tf"]), Node("other"))
        listener.tf._frames.put("moon", "sky", 0, Transform.of("sky", "moon").pose, is_static=True)
        waiting = asyncio.ensure_future(listener.tf.lookup("odom", "moon", timeout=0.5))
        await graph.clock.advance(0.5)
        await waiting
    await graph.stop(odometry)
    with pytest.raises(ExtrapolationError, match=r"the node that published it has ended$"):
        listener.tf.get("odom", "base_link", Time(graph.clock.time_ns() + 10**9))


async def test_a_publisher_that_stops(graph: Graph) -> None:
    """The error says since when."""
    listener, sender = Listener(), Listener("odometry")
    await graph.start(listener, sender)
    for _ in range(5):
        sender.tf.send(Transform.of("odom", "base_link"))
        await graph.clock.advance(0.5)
    await graph.clock.advance(3.5)
    with pytest.raises(
        ExtrapolationError, match=r"4\.00 s older; /odometry publishes it at 2 Hz, and stopped 4\.00 s ago"
    ):
        listener.tf.get("odom", "base_link", graph.clock.now())


async def test_a_slow_publisher(graph: Graph) -> None:
    """It has not stopped if less than three of its periods have passed."""
    listener, sender = Listener(), Listener("odometry")
    await graph.start(listener, sender)
    for _ in range(5):
        sender.tf.send(Transform.of("odom", "base_link"))
        await graph.clock.advance(2.0)
    await graph.clock.advance(3.0)
    with pytest.raises(ExtrapolationError, match=r"5\.00 s older; /odometry publishes it at 0\.5 Hz$"):
        listener.tf.get("odom", "base_link", graph.clock.now())


async def test_messages(graph: Graph) -> None:
    """A message with a header is converted at the time of its stamp."""
    listener = Listener()
    await graph.start(listener, Odometry(), Laser())
    await graph.clock.advance(0.1)
    seen = PointStamped(header=Header(stamp=graph.clock.now(), frame_id="laser"))
    seen.point.x = 2.0
    out = await listener.tf.transform(seen, "odom")
    assert (out.point.x, out.header.frame_id) == (pytest.approx(-1.9), "odom")
    with pytest.raises(TypeError, match="a Transform has no header"):
        await listener.tf.transform(Transform.of("a", "b"), "odom")


async def test_warnings(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Once each: a slash, a fault, two publishers of one frame, a second parent, a loop, a time long past."""
    listener, first, second = Listener(), Listener("first"), Listener("second")
    await graph.start(listener, first, second)
    raw = graph.publisher(TFMessage, "/tf")
    for _ in range(2):
        raw.publish(TFMessage(transforms=[Transform.of("/map", "/odom").to_msg()]))
        raw.publish(TFMessage(transforms=[Transform.of("odom", "base", rotation=(0.0, 0.0, 0.0, 0.0)).to_msg()]))
        for sender in (first, second):
            sender.tf.send(Transform.of("odom", "base_link"))
        await graph.clock.advance(0.1)
    first.tf.send(Transform.of("map", "base_link"))
    await graph.settle()
    first.tf.send(Transform.of("base_link", "map"))
    await graph.clock.advance(1.0)
    raw.publish(TFMessage(transforms=[Transform.of("odom", "arm", stamp=Time(10**11)).to_msg()]))
    raw.publish(TFMessage(transforms=[Transform.of("odom", "arm", stamp=Time(10**9)).to_msg()]))
    await graph.settle()
    ours = [r.getMessage() for r in caplog.records if r.levelno == logging.WARNING and "listener" in r.name]
    assert len(ours) == 6, ours
    for text in (
        "sends the frame '/odom': names of frames have no slash in front since ROS 2; it is read as 'odom'",
        "is dropped: the quaternion of 'base' is not normalized",
        "/first and /second both publish odom -> base_link, and its place jumps between the two; stop one of them",
        "base_link is placed in odom by /second, and now in map by /first: a frame has one parent;",
        "with a transform of /first the frames form a loop: map -> base_link -> map;",
        "a transform of 'arm' from",
    ):
        assert any(text in line for line in ours), text


async def test_nothing_but_faults(graph: Graph) -> None:
    """A lookup names the fault for which all transforms were dropped."""
    listener = Listener()
    await graph.start(listener)
    raw = graph.publisher(TFMessage, "/tf")
    raw.publish(TFMessage(transforms=[Transform.of("odom", "base", rotation=(0.0, 0.0, 0.5, 1.0)).to_msg()]))
    await graph.settle()
    with pytest.raises(UnknownFrame, match="all transforms so far were dropped: the quaternion of 'base' is not norm"):
        listener.tf.get("odom", "base")


def test_what_is_sent_is_checked() -> None:
    """A transform that every listener would drop is refused where it is sent."""
    node = Listener()
    for transform, text in (
        (Transform.of("odom", "base", rotation=(0.0, 0.0, 0.0, 90.0)), "'base' is not normalized"),
        (Transform.of("odom", "/base"), "no slash in front: write 'base' in 'odom'"),
        (Transform.of("odom", "odom"), "are both 'odom'"),
        (Transform.of("odom", "base", (math.nan, 0.0, 0.0)), "infinite or not a number"),
    ):
        with pytest.raises(TransformError, match=text):
            node.tf.send(transform)


async def test_static_transforms_reach_late_listeners(graph: Graph) -> None:
    """All those of a node, with one message."""
    sender = Listener("sender")
    await graph.start(sender)
    sender.tf.send_static(Transform.of("base_link", "laser", (0.1, 0.0, 0.0)))
    sender.tf.send_static(Transform.of("base_link", "camera", (0.2, 0.0, 0.0)))
    sender.tf.send_static(Transform.of("base_link", "laser", (0.3, 0.0, 0.0)))
    late = Listener()
    await graph.start(late)
    await graph.settle()
    assert late.tf.get("laser", "camera").translation == pytest.approx((-0.1, 0.0, 0.0))


async def test_a_node_that_does_not_listen(graph: Graph) -> None:
    """Its lookups are a mistake that is named."""
    odometry = Odometry()
    await graph.start(odometry)
    with pytest.raises(DeclarationError, match="/odometry does not listen to transforms"):
        odometry.tf.get("odom", "base_link")


async def test_time_that_begins_again(graph: Graph) -> None:
    """A simulation's transforms of before are forgotten when its time jumps back, except for static ones."""
    from graphflow.msgs.rosgraph_msgs.msg import Clock

    clock, listener, sender = graph.publisher(Clock, "/clock"), Listener(use_sim_time=True), Listener("sender")
    await graph.start(listener, sender)
    sender.tf.send_static(Transform.of("base_link", "laser", (0.0, 0.0, 1.0)))
    message = Clock()
    for second in (100, 101, 5):
        message.clock.sec = second
        clock.publish(message)
        await graph.settle()
        sender.tf.send(Transform.of("odom", "base_link", (float(second), 0.0, 0.0), stamp=Time(second * 10**9)))
        await graph.settle()
    assert listener.tf.get("odom", "base_link").translation == (5.0, 0.0, 0.0)
    assert listener.tf.get("odom", "laser").translation == (5.0, 0.0, 1.0)


async def test_frames_of_other_nodes_are_bounded(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither frames nor warnings nor waits grow without end."""
    monkeypatch.setattr("graphflow.tf.frames.FRAMES_BOUND", 20)
    monkeypatch.setattr("graphflow.tf.reports.REPORTED_BOUND", 5)
    listener = Listener()
    await graph.start(listener)
    raw = graph.publisher(TFMessage, "/tf")
    raw.publish(TFMessage(transforms=[Transform.of(f"/p{i}", f"f{i}").to_msg() for i in range(100)]))
    await graph.settle()
    assert len(listener.tf.frames) <= 20
    assert len(listener.tf._senders) <= 20
    assert len(listener.tf._reports._reported) == 5


class Follower(Node):
    tf = Transforms()

    @task
    async def follow(self) -> None:
        self.found = await self.tf.lookup("odom", "base_link", timeout=None)


async def test_a_wait_without_limit(graph: Graph) -> None:
    """It ends with the transform, or with the node."""
    waits, ends = Follower("waits"), Follower("ends")
    await graph.start(waits, ends)
    await graph.clock.advance(60.0)
    await graph.stop(ends)
    assert ends.tf._waits == {}
    await graph.start(Odometry())
    await graph.clock.advance(0.1)
    assert waits.found.translation == pytest.approx((0.1, 0.0, 0.0))


async def test_a_number_in_place_of_a_time(graph: Graph) -> None:
    """Its error has the time to write."""
    listener = Listener()
    await graph.start(listener)
    seconds: Any = 12.5
    with pytest.raises(TypeError, match=r"at= takes a Time or a message's stamp, not 12.5; .* self.clock.now\(\)"):
        await listener.tf.lookup("odom", "base", at=seconds)


def test_words_of_rclpy() -> None:
    """An error names the method to call."""
    with pytest.raises(AttributeError) as caught:
        Listener().tf.lookup_transform("map", "base")  # type: ignore[attr-defined]
    assert "self.tf.lookup(target, source" in better_text(caught.value)


class Mount(Node):
    tf = Transforms(listen=False)


async def test_a_sender_that_has_sent_already(graph: Graph) -> None:
    """A fixed frame that was sent once on /tf is lost for a late listener, which says who should send it again."""
    mount = Mount()
    await graph.start(mount)
    mount.tf.send(Transform.of("base_link", "laser"))
    await graph.settle()
    listener = Listener()
    await graph.start(listener)
    await graph.settle()
    with pytest.raises(UnknownFrame) as caught:
        listener.tf.get("base_link", "laser")
    told = (
        "; /mount publishes transforms, and has sent none since this node listens: a frame that never moves needs send"
    )
    assert told in str(caught.value)


async def test_a_moving_frame_as_static(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """After a few different poses it is told; a correction or two is none."""
    node = Mount()
    await graph.start(node)
    for x in (0.0, 1.0, 2.0):
        node.tf.send_static(Transform.of("odom", "base_link", (x, 0.0, 0.0)))
    assert "is sent as static" not in caplog.text
    for x in (3.0, 4.0, 5.0):
        node.tf.send_static(Transform.of("odom", "base_link", (x, 0.0, 0.0)))
    assert caplog.text.count("odom -> base_link is sent as static with another pose each time") == 1


async def test_two_parents_by_turns(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Two publishers that place a frame in two others are not told to publish the same."""
    listener, first, second = Listener(), Listener("first"), Listener("second")
    await graph.start(listener, first, second)
    for _ in range(3):
        first.tf.send(Transform.of("map", "base"))
        await graph.clock.advance(0.1)
        second.tf.send(Transform.of("odom", "base"))
        await graph.clock.advance(0.1)
    assert any(text.startswith("base is placed in ") and "a frame has one parent" in text for text in caplog.messages)
    assert not any("both publish" in text for text in caplog.messages)
