"""Bags that viewers play, pause and seek in."""

from __future__ import annotations

import asyncio
import struct
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from graphflow.bag.reader import Bag
from graphflow.errors import BagError
from graphflow.viewer import playback as playback_module
from graphflow.viewer.playback import Playback
from graphflow.viewer.protocol import ENDED, PAUSED
from tests.bag.cast import SECOND, START, write
from tests.viewer.cast import Viewer, viewer

pytestmark = pytest.mark.usefixtures("graphflow_runner")


def control(command: int, speed: float = 1.0, seconds: float | None = None, request_id: bytes = b"r") -> bytes:
    """A request: command 0 plays, 1 pauses."""
    sought = 0 if seconds is None else START + round(seconds * SECOND)
    return struct.pack("<BBfBQI", 3, command, speed, seconds is not None, sought, len(request_id)) + request_id


def position(seconds: float) -> int:
    return START + round(seconds * SECOND)


@asynccontextmanager
async def played(folder: Path) -> AsyncIterator[tuple[Playback, Viewer]]:
    playback = Playback(Bag(write(folder / "bag")), "lab")
    try:
        port = await playback.open("127.0.0.1", 0)
        async with viewer(port) as seen:
            yield playback, seen
    finally:
        await playback.close()


async def test_the_span_and_the_topics(tmp_path: Path) -> None:
    """They are told at once; the bag stands at its beginning."""
    async with played(tmp_path) as (_, seen):
        assert seen.info["capabilities"] == ["time", "playbackControl", "assets"]
        assert seen.info["dataStartTime"] == {"sec": START // SECOND, "nsec": START % SECOND}
        end_ns = position(1.95)
        assert seen.info["dataEndTime"] == {"sec": end_ns // SECOND, "nsec": end_ns % SECOND}
        await seen.until(lambda: len(seen.channels) == 3)
        assert seen.channels["/chatter"]["schemaName"] == "std_msgs/msg/String"
        await seen.until(lambda: seen.states == [(PAUSED, START, 1.0, 0)])


async def test_playing_to_the_end_and_again(tmp_path: Path) -> None:
    """Messages come in order with their times; at the end it stops, and begins again when played."""
    async with played(tmp_path) as (_, seen):
        await seen.subscribe(7, "/chatter")
        await seen.until(lambda: seen.messages)  # the latest one at the beginning
        await seen.say(control(0, 50.0))
        await seen.until(lambda: seen.states[-1][0] == ENDED)
        await seen.until(lambda: len(seen.messages) == 21)
        assert [message.log_ns for message in seen.messages[1:]] == [position(n / 10) for n in range(20)]
        assert seen.states[-1][:2] == (ENDED, position(1.95))
        assert seen.times == sorted(seen.times)
        await seen.say(control(0, 50.0))
        await seen.until(lambda: len(seen.messages) == 41)


async def test_pausing_and_seeking(tmp_path: Path) -> None:
    """A viewer gets the latest message of each topic at the time that it seeks; while paused no more come."""
    async with played(tmp_path) as (playback, seen):
        await seen.subscribe(1, "/map")
        await seen.subscribe(2, "/count")
        await seen.until(lambda: seen.messages)
        seen.messages.clear()
        await seen.say(control(1, 1.0, 1.02))
        await seen.until(lambda: len(seen.messages) == 2)
        assert {(m.subscription, m.log_ns) for m in seen.messages} == {(1, START), (2, position(0.95))}
        assert seen.states[-1] == (PAUSED, position(1.02), 1.0, 1)
        await asyncio.sleep(0.1)
        assert len(seen.messages) == 2
        await seen.say(control(0, 1.0))
        await seen.until(lambda: seen.messages[-1].log_ns >= position(1.15))
        await seen.say(control(1, 1.0))
        await seen.until(lambda: seen.states[-1][0] == PAUSED)
        count = len(seen.messages)
        assert position(1.1) < playback.now_ns < position(1.95)
        await asyncio.sleep(0.15)
        assert len(seen.messages) == count
        await seen.say(control(1, 1.0, -5.0))
        await seen.until(lambda: playback.now_ns == START)


async def test_what_is_near_and_what_is_rare(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a topic with many messages, only near ones are looked for."""
    monkeypatch.setattr(playback_module, "FEW", 5)
    monkeypatch.setattr(playback_module, "LOOK_BACK_NS", 10_000_000)
    async with played(tmp_path) as (_, seen):
        await seen.say(control(1, 1.0, 1.04))
        await seen.subscribe(1, "/map")
        await seen.subscribe(2, "/count")
        await seen.subscribe(3, "/chatter")
        await seen.until(lambda: seen.messages)
        await asyncio.sleep(0.1)
        assert [(m.subscription, m.log_ns) for m in seen.messages] == [(1, START)]


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        (control(0, -1.0), "a bag cannot be played at -1 times its speed"),
        (control(0, float("nan")), "a bag cannot be played at nan times"),
        (control(7), "bytes do not follow the protocol"),
        (control(0)[:-1], "bytes do not follow the protocol"),
        (control(0, request_id=b"x" * 1001), "bytes do not follow the protocol"),
        (b"\x01\x01\x00\x00\x00x", "a bag can only be watched"),
    ],
)
async def test_requests_that_are_wrong(tmp_path: Path, wrong: bytes, text: str) -> None:
    """They are answered with a warning, and change nothing."""
    async with played(tmp_path) as (playback, seen):
        await seen.say(wrong)
        await seen.until(lambda: seen.statuses)
        assert text in seen.statuses[0]
        assert playback.now_ns == START


async def test_channels_that_are_wrong(tmp_path: Path) -> None:
    """An unknown channel, and a number that is taken, are refused."""
    async with played(tmp_path) as (_, seen):
        await seen.subscribe(1, "/map")
        await seen.subscribe(1, "/count")
        await seen.send("subscribe", subscriptions=[{"id": 2, "channelId": 99}])
        await seen.until(lambda: len(seen.statuses) == 2)
        assert seen.statuses[1] == "there is no channel 99"
        await seen.send("unsubscribe", subscriptionIds=[1, 5])
        await seen.send("getParameters", parameterNames=[], id="p")
        await seen.send("subscribeConnectionGraph")


def test_an_empty_bag(tmp_path: Path) -> None:
    """There is nothing to play."""
    with pytest.raises(BagError, match="it has no messages"):
        Playback(Bag(write(tmp_path / "bag", [])), "lab")
