"""Publishers at work, and how a message that cannot be sent is answered."""

from __future__ import annotations

import asyncio
import os
from concurrent.futures import ThreadPoolExecutor
from random import Random
from typing import Any

import pytest

from graphflow import EncodeError, Node, Publisher, Qos, Subscription
from graphflow.errors import ClosedError
from graphflow.msgs.geometry_msgs.msg import Pose
from graphflow.msgs.nav_msgs.msg import Path
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.runtime.endpoints import publishers
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.node_core import core_of
from graphflow.testing import Graph
from tests.runtime.cast import Speaker


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (Int32(), r"/chatter carries std_msgs/msg/String, not std_msgs\.msg\.Int32"),
        ("hello", r"/chatter carries std_msgs/msg/String, not 'hello'; write String\(data=\.\.\.\)$"),
        (5, r"/chatter carries std_msgs/msg/String, not 5; write String\(data=str\(\.\.\.\)\)$"),
        (None, "/chatter carries std_msgs/msg/String, not None"),
    ],
)
async def test_publishing_another_type_is_an_error(graph: Graph, message: Any, text: str) -> None:
    """EncodeError names the topic, its type and the value; no message is sent."""
    node = Speaker()
    await graph.start(node)

    with pytest.raises(EncodeError, match=text):
        node.chatter.publish(message)

    assert node.chatter.published == 0


async def test_publishing_a_wrong_field_is_an_error(graph: Graph) -> None:
    """EncodeError names the field; the message is not sent, and the next one is."""
    node = Speaker()
    await graph.start(node)
    wrong = String()
    wrong.data = 5  # type: ignore[assignment]

    with pytest.raises(EncodeError, match="data"):
        node.chatter.publish(wrong)
    node.chatter.publish(String(data="good"))
    await graph.settle()

    assert node.chatter.published == 1
    assert node.heard.received == 1


class Lidar(Node):
    """Publishes scans."""

    scan = Publisher(LaserScan, "scan")
    heard = Subscription(LaserScan, "scan")


async def test_first_messages_are_checked(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """A contradiction is told once, and the messages are sent all the same; then the usual `publish` takes over."""
    await graph.start(node := Lidar())
    checking = node.scan.publish
    for _ in range(3):
        node.scan.publish(LaserScan(ranges=[1.0, 2.0]))
    await graph.settle()
    [told] = [text for text in caplog.messages if "angle_increment" in text]
    assert ": /scan: angle_increment is 0, so that all 2 ranges are in one direction" in told
    assert node.scan.publish is not checking
    assert (node.scan.published, node.heard.received) == (3, 3)


class Unheard(Node):
    """Publishers of topics without subscriptions."""

    path = Publisher(Path, "path")
    words = Publisher(String, "words")


async def test_the_first_message_without_subscriptions_is_checked(graph: Graph) -> None:
    """EncodeError names the field, until a message fits; later messages are not encoded."""
    node = Unheard()
    await graph.start(node)
    wrong = String()
    wrong.data = 5  # type: ignore[assignment]

    for _ in range(2):
        with pytest.raises(EncodeError, match=r"String\.data: expected string, got 5; write '5'"):
            node.words.publish(wrong)
    assert node.words.published == 0
    node.words.publish(String(data="good"))
    node.words.publish(wrong)

    assert node.words.published == node.words.unheard == 2


async def test_the_elements_of_a_first_message_without_subscriptions_are_checked(graph: Graph) -> None:
    """EncodeError names the element of another message class."""
    node = Unheard()
    await graph.start(node)
    path = Path()
    path.poses.append(Pose())  # type: ignore[arg-type]

    with pytest.raises(EncodeError, match=r"Path\.poses\[0\]"):
        node.path.publish(path)


def test_a_message_that_a_constructor_publishes() -> None:
    """It comes too early; the error names where it can be published."""

    class Early(Node):
        words = Publisher(String, "chatter")

        def __init__(self) -> None:
            super().__init__()
            self.words.publish(String())

    with pytest.raises(ClosedError, match="node /early does not run yet in __init__; do this in async def on_start"):
        Early()


def test_a_message_of_a_handler_that_a_constructor_calls() -> None:
    """The line that calls it is the cause, and is told with the form that passes it on."""

    class Early(Node):
        words = Publisher(String, "chatter")

        def __init__(self, *, is_passed: bool) -> None:
            super().__init__()
            if is_passed:
                self.create_timer(1.0, self.tick())  # type: ignore[func-returns-value, arg-type]
            self.tick()

        def tick(self) -> None:
            self.words.publish(String())

    line = Early.__init__.__code__.co_firstlineno + 3
    with pytest.raises(ClosedError, match=rf"in __init__; line {line}: create_timer\(.*\) calls tick at once"):
        Early(is_passed=True)
    with pytest.raises(ClosedError, match="does not run yet in __init__; do this in async def on_start"):
        Early(is_passed=False)


async def test_publishing_needs_a_running_node(graph: Graph) -> None:
    """Publishing before the start and after the stop raises an error and is not counted."""
    node = Speaker()
    with pytest.raises(
        ClosedError, match=r"/chatter: node /speaker is not running; use this from .* async with graphflow.running"
    ):
        node.chatter.publish(String())
    await graph.start(node)
    node.chatter.publish(String())
    await graph.stop(node)
    with pytest.raises(ClosedError, match="not running"):
        node.chatter.publish(String())

    assert node.chatter.published == 1
    with pytest.raises(ClosedError):
        node.chatter.get_subscription_count()


async def test_a_publisher_that_is_paused_sends_nothing(graph: Graph) -> None:
    """Not even later, and the warning has the reason; then it sends as before."""
    speaker = Speaker("speaker")
    await graph.start(speaker)
    heard = graph.tap(String, "/chatter")
    await graph.settle()
    speaker.chatter.pause("it is night")
    speaker.chatter.publish(String(data="night"))
    assert not speaker.chatter.is_wanted
    speaker.chatter.resume()
    speaker.chatter.publish(String(data="day"))
    await graph.settle()
    assert [message.data for message in heard] == ["day"]
    assert speaker.chatter.published == 1


def test_a_second_thread_waits_for_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """Once; from then on both take the lock."""
    order = publishers._Order()
    order.look_who_publishes()
    order.is_sending = True
    waited: list[float] = []

    def sleep(seconds: float) -> None:
        waited.append(seconds)
        order.is_sending = len(waited) < 3

    monkeypatch.setattr(publishers, "sleep", sleep)
    with ThreadPoolExecutor(1) as other:
        other.submit(order.look_who_publishes).result(10.0)
    assert (order.is_shared, len(waited)) == (True, 3)
    order.is_sending = True
    order.look_who_publishes()
    assert len(waited) == 3


class Sent:
    """A sender that keeps its payloads, is not always wanted, and sometimes fails."""

    def __init__(self) -> None:
        self.log: list[tuple[bytes, bytes]] = []
        self.is_wanted, self.fails = True, False

    def put(self, payload: Any, *, attachment: bytes) -> None:
        if self.fails:
            raise OSError("the network is down")
        self.log.append((bytes(payload), attachment))

    def close(self) -> None:
        """Do nothing."""


class Here:
    """A subscription of the same process."""

    def __init__(self) -> None:
        self.log: list[Any] = []

    def hand(self, handed: Any) -> None:
        self.log.append((handed.fields, handed.take()))


@pytest.mark.parametrize("seed", range(10))
async def test_the_short_way_to_publish_is_the_general_one(graph: Graph, seed: int) -> None:
    """Whatever comes: other types, wrong fields, other threads, listeners here and none, pauses, failures."""
    node = Speaker()
    await graph.start(node)
    both = short, general = [TopicPublisher(core_of(node), String, "/x", Qos()) for _ in range(2)]
    outs, heres = [Sent(), Sent()], [Here(), Here()]
    for publisher, out in zip(both, outs, strict=True):
        publisher.open()
        publisher._lengthen()
        publisher._sender, publisher._put, publisher._here = out, out.put, []
        publisher._gid = bytes(16)
    short._shorten()
    assert "publish" in vars(short)
    assert "publish" not in vars(general)
    general._shorten = lambda: None  # type: ignore[method-assign]
    random, wrong = Random(seed), String()
    wrong.data = 5  # type: ignore[assignment]
    with ThreadPoolExecutor(1) as other:
        for step in range(80):
            act = random.choice(
                ["good"] * 8 + ["type", "field", "thread", "wanted", "fails", "here", "pause", "resume"]
            )
            answers = []
            for publisher, out, here in zip(both, outs, heres, strict=True):
                answers.append(_act(act, step, publisher, out, here, other, wrong))
            assert answers[0] == answers[1], act
            await graph.clock.advance(0.001)
    assert outs[0].log == outs[1].log
    assert heres[0].log == heres[1].log
    assert short.published == general.published > 0
    for publisher in both:
        publisher.close()


def _act(
    act: str, step: int, publisher: Any, out: Sent, here: Here, other: ThreadPoolExecutor, wrong: String
) -> str | None:
    """Do one thing; returns the text of the error."""
    message = {"type": Int32(), "field": wrong}.get(act, String(data=str(step)))
    try:
        match act:
            case "thread":
                other.submit(publisher.publish, message).result()
            case "wanted":
                out.is_wanted = not out.is_wanted
            case "fails":
                out.fails = not out.fails
            case "here":
                publisher._here[:] = [] if publisher._here else [here]
            case "pause":
                publisher.pause("it is tired")
            case "resume":
                publisher.resume()
            case _:
                publisher.publish(message)
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return None


async def test_a_child_process(graph: Graph) -> None:
    """A message of a child process would be lost: there its publishers raise an error."""
    await graph.start(node := Speaker())
    child = os.fork()
    if not child:
        try:
            node.chatter.publish(String(data="lost"))
        except ClosedError as error:
            os._exit(7 * ("nothing is published in a child process" in str(error)))
        os._exit(1)
    _, status = await asyncio.to_thread(os.waitpid, child, 0)
    assert os.waitstatus_to_exitcode(status) == 7
    node.chatter.publish(String(data="sent"))
    assert node.chatter.published == 1
