"""Synchronizers whose inputs never have stamps that fit together."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import pytest
from geometry_msgs.msg import PointStamped
from message_filters import ApproximateTimeSynchronizer, SimpleFilter, TimeSynchronizer

from rclpy.impl.mistakes import unmatched_stamps
from rclpy.time import Time

MS = 10**6
TIMES = range(0, 5000, 100)


@pytest.fixture(autouse=True)
def _soon(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unmatched_stamps, "WARN_AFTER", 0.0)


class Source(SimpleFilter):
    """A filter with a topic's name."""

    def __init__(self, topic_name: str) -> None:
        super().__init__()
        self.topic_name = topic_name

    def send(self, ms: float) -> None:
        message = PointStamped()
        message.header.stamp = Time(nanoseconds=round(ms * MS)).to_msg()
        self.signalMessage(message)


def exact(sources: Sequence[SimpleFilter]) -> TimeSynchronizer:
    return TimeSynchronizer(sources, 10)


def near(sources: Sequence[SimpleFilter]) -> TimeSynchronizer:
    return ApproximateTimeSynchronizer(sources, 10, 0.03)


def late(ms: float) -> float:
    """The stamp of a message that is stamped 3 seconds before it arrives."""
    return ms - 3000


HAD = "has received 11 messages of each of /a and /b, and no complete set: "


@pytest.mark.parametrize(
    ("make", "other", "text"),
    [
        (
            exact,
            lambda ms: ms + 0.4,
            "their stamps differ by at least 0.4 ms, and must be equal; write "
            "ApproximateTimeSynchronizer([...], 10, 0.01)",
        ),
        (near, lambda ms: ms + 45, "their stamps differ by at least 45 ms, and slop=0.03; write slop=0.1"),
        (
            exact,
            lambda ms: ms + 1e7,
            "their stamps differ by at least 9999.0 s; compare the clocks that they come from",
        ),
        (
            near,
            lambda _: 0,
            "those of /b have no stamp; write message.header.stamp = self.get_clock().now().to_msg() "
            "where they are made",
        ),
    ],
)
def test_stamps_that_never_fit(
    make: Callable[..., TimeSynchronizer], other: Callable[[float], float], text: str, caplog: pytest.LogCaptureFixture
) -> None:
    """It is told once, with what to write."""
    a, b = Source("/a"), Source("/b")
    kind = type(make([a, b])).__name__
    for ms in TIMES:
        a.send(ms + 1000)
        b.send(other(ms + 1000) if text[0] == "t" else other(ms))
    line = make.__code__.co_firstlineno + 1
    assert caplog.messages == [f"test_unmatched_stamps.py:{line}: this {kind} {HAD}{text}"]


@pytest.mark.parametrize("make", [exact, near])
def test_a_queue_that_is_too_short(make: Callable[..., TimeSynchronizer], caplog: pytest.LogCaptureFixture) -> None:
    """Stamps fit, but the messages of one input arrive when those of the other have been dropped."""
    a, b = Source("/a"), Source("/b")
    make([a, b])
    for ms in range(1000, 6000, 100):
        a.send(ms)
        if ms >= 4000:
            b.send(ms - 3000)
    [text] = caplog.messages
    assert text.endswith("some come so late that the others are dropped before; write queue_size=62")


@pytest.mark.parametrize("make", [exact, near])
def test_synchronizers_that_work(make: Callable[..., TimeSynchronizer], caplog: pytest.LogCaptureFixture) -> None:
    """One with sets now and then, one whose second input is silent, and one that has passed on a set long ago."""
    a, b = Source("/a"), Source("/b")
    heard: list[object] = []
    make([a, b]).registerCallback(lambda *got: heard.append(got))
    for ms in TIMES:
        a.send(ms)
        if ms % 500 == 0:
            b.send(ms)
    silent = Source("/c")
    make([a, silent])
    make([a]).registerCallback(print)
    for ms in TIMES:
        a.send(ms + 6000)
        b.send(ms + 16050)
    assert len(heard) == len(TIMES) // 5
    assert caplog.messages == []


def test_patience(caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is told of the first seconds."""
    monkeypatch.setattr(unmatched_stamps, "WARN_AFTER", 100.0)
    a, b = Source("/a"), Source("/b")
    exact([a, b])
    for ms in TIMES:
        a.send(ms)
        b.send(ms + 1)
    assert caplog.messages == []


def test_long_queues(monkeypatch: pytest.MonkeyPatch) -> None:
    """However long they are, only so many stamps are kept, and only so many messages are waited for."""
    monkeypatch.setattr(unmatched_stamps, "KEPT_BOUND", 200)
    monkeypatch.setattr(unmatched_stamps, "ENOUGH_BOUND", 50)
    watch = unmatched_stamps.Unmatched("TimeSynchronizer", "a.py:1", ["/a", "/b"], 10_000, 0)
    assert [stamps.maxlen for stamps in watch._stamps] == [200, 200]
    assert watch._enough == 50
