"""Filters that messages pass."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from geometry_msgs.msg import PointStamped
from message_filters import ApproximateTimeSynchronizer, Cache, SimpleFilter, Subscriber, TimeSynchronizer
from std_msgs.msg import Int32

from rclpy.node import Node
from rclpy.time import Time

MS = 10**6


def at(ms: int) -> PointStamped:
    message = PointStamped()
    message.header.stamp = Time(nanoseconds=ms * MS).to_msg()
    return message


def stamps(messages: tuple[Any, ...]) -> list[int]:
    return [Time.from_msg(message.header.stamp).nanoseconds // MS for message in messages]


def test_a_subscription_is_one(node: Node, spin: Callable[..., None]) -> None:
    """With arguments behind its messages, and what a subscription has."""
    heard: list[Any] = []
    subscriber = Subscriber(node, PointStamped, "points")
    subscriber.registerCallback(lambda *got: heard.append(got), "extra")
    node.create_publisher(PointStamped, "points", 10).publish(at(3))
    spin(lambda: heard)
    assert heard == [(at(3), "extra")]
    assert (subscriber.getTopic(), subscriber.topic_name) == ("points", "/points")


def test_a_cache() -> None:
    """Of so many messages, to be asked by time."""
    source = SimpleFilter()
    cache = Cache(source, 3)
    assert (cache.getLast(), cache.getOldestTime(), cache.getLatestTime()) == (None, None, None)
    for ms in (10, 20, 30, 40):
        source.signalMessage(at(ms))
    assert stamps(tuple(cache.cache_msgs)) == [20, 30, 40]
    times = [Time(nanoseconds=ms * MS, clock_type=cache.cache_times[0].clock_type) for ms in (20, 35, 99)]
    assert stamps(tuple(cache.getInterval(times[0], times[1]))) == [20, 30]
    assert stamps((cache.getElemAfterTime(times[1]), cache.getElemBeforeTime(times[1]), cache.getLast())) == [
        40,
        30,
        40,
    ]
    assert (cache.getElemAfterTime(times[2]), cache.getOldestTime()) == (None, times[0])


def test_the_same_stamps() -> None:
    """One of each; what is too old is forgotten."""
    sources, heard = [SimpleFilter(), SimpleFilter()], list[Any]()
    TimeSynchronizer(sources, 2).registerCallback(lambda *got: heard.append(stamps(got)))
    for which, ms in ((0, 1), (0, 2), (0, 3), (1, 1), (1, 3), (1, 2)):
        sources[which].signalMessage(at(ms))
    assert heard == [[3, 3], [2, 2]]


def test_stamps_that_are_near() -> None:
    """The nearest of each, within the slop; each message once."""
    sources, heard = [SimpleFilter() for _ in range(3)], list[Any]()
    ApproximateTimeSynchronizer(sources, 10, 0.01).registerCallback(lambda *got: heard.append(stamps(got)))
    for which, ms in ((0, 100), (1, 104), (1, 101), (2, 95), (2, 102), (0, 200), (1, 220), (2, 200)):
        sources[which].signalMessage(at(ms))
    assert heard == [[100, 101, 95]]
    sources[1].signalMessage(at(201))
    assert heard[1:] == [[200, 201, 200]]


def test_messages_without_a_stamp(capfd: pytest.CaptureFixture[str]) -> None:
    """They count where that is allowed; else a warning says so."""
    sources, heard = [SimpleFilter(), SimpleFilter()], list[Any]()
    ApproximateTimeSynchronizer(sources, 10, 5.0, allow_headerless=True).registerCallback(
        lambda *got: heard.append(got)
    )
    Cache(sources[0]).registerCallback(heard.append)
    for source in sources:
        source.signalMessage(Int32(data=1))
    assert heard == [(Int32(data=1), Int32(data=1))]
    assert "allow_headerless=True" in capfd.readouterr().err


def told(caplog: pytest.LogCaptureFixture, text: str) -> list[str]:
    return [message for record in caplog.records if text in (message := record.getMessage())]


def test_a_synchronizer_without_a_callback(caplog: pytest.LogCaptureFixture) -> None:
    """Is told once, with its line; one that gets its callback meanwhile, or that hands on, is not."""
    source, after = SimpleFilter(), SimpleFilter()
    made = [TimeSynchronizer([source], 10), ApproximateTimeSynchronizer([source], 10, 0.1)]
    line = test_a_synchronizer_without_a_callback.__code__.co_firstlineno + 3
    late, chained = TimeSynchronizer([source], 10), TimeSynchronizer([source], 10)
    Cache(chained)
    for ms in (10, 20):
        source.signalMessage(at(ms))
    late.registerCallback(after.signalMessage)
    for ms in (30, 40, 50):
        source.signalMessage(at(ms))
    text = "this synchronizer has matched messages, but has no callback"
    way = "write synchronizer.registerCallback(self.callback)"
    assert told(caplog, text) == [f"test_message_filters.py:{line}: {text}; {way}"] * len(made)


def test_a_subscription_that_is_no_filter(node: Node) -> None:
    """Is refused with the filter to write."""
    plain = node.create_subscription(PointStamped, "points", print, 10)
    text = r"TimeSynchronizer takes filters, .* write message_filters.Subscriber\(self, PointStamped, '/points'\)"
    with pytest.raises(AttributeError, match=text):
        TimeSynchronizer([plain], 10)  # type: ignore[list-item]
    with pytest.raises(AttributeError, match="Cache takes filters"):
        Cache(plain)  # type: ignore[arg-type]


def test_messages_without_a_stamp_are_told_now_and_then(caplog: pytest.LogCaptureFixture) -> None:
    """Not each of them."""
    source = SimpleFilter()
    ApproximateTimeSynchronizer([source], 10, 0.1)
    for _ in range(5):
        source.signalMessage(Int32())
    assert len(told(caplog, "a message without a stamp is dropped")) <= 1


def test_a_subscriber_without_a_node() -> None:
    """The error has the order of its arguments."""
    wrong: Any = Subscriber
    with pytest.raises(TypeError, match=r"Subscriber takes the node first: Subscriber\(self, LaserScan, 'scan'\)"):
        wrong("scan", PointStamped)
