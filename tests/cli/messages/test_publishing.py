"""The work of `topic pub`."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow import Node
from graphflow.cli import exits
from graphflow.cli.messages.publishing import UNHEARD_AFTER, Draft, PubOptions, _publish
from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph

WORD = String(data="x")
NEVER = 0


async def begun(graph: Graph, options: PubOptions) -> asyncio.Task[int]:
    """A hidden node that is publishing."""
    await graph.start(node := Node("_pub"))
    task = asyncio.ensure_future(_publish(node, "/said", [Draft(WORD)], options))
    await graph.settle()
    return task


async def test_so_many_times_at_a_rate(graph: Graph, capsys: pytest.CaptureFixture[str]) -> None:
    """The first message is published at once, the others a period apart, and each is printed."""
    heard = graph.tap(String, "/said")
    task = await begun(graph, PubOptions(rate=2.0, times=3))
    assert len(heard) == 1
    await graph.clock.advance(0.5)
    assert len(heard) == 2
    await graph.clock.advance(5.0)
    assert task.result() == exits.OK
    assert list(heard) == [WORD] * 3
    lines = [f"publishing #{n}: std_msgs.msg.String(data='x')\n" for n in (1, 2, 3)]
    assert capsys.readouterr().out == "\n".join(["publisher: beginning loop", *lines]) + "\n"


async def test_without_a_number_it_goes_on(graph: Graph) -> None:
    """Without a number, publishing continues until it is ended, and waits for no subscription."""
    task = await begun(graph, PubOptions())
    heard = graph.tap(String, "/said")
    await graph.clock.advance(100.0)
    assert len(heard) == 100
    assert not task.done()
    task.cancel()


@pytest.mark.filterwarnings("ignore:no node publishes")
async def test_once_waits_for_a_listener(graph: Graph, capsys: pytest.CaptureFixture[str]) -> None:
    """A single message is published only once there is a subscription; the wait is reported."""
    graph.tap(String, "/sad")
    task = await begun(graph, PubOptions(once=True))
    await graph.clock.advance(100.0)
    told = capsys.readouterr()
    assert told.out == "Waiting for at least 1 matching subscription(s)...\n"
    assert told.err == (
        "no node subscribes to /said so far; Ctrl-C ends the wait, and -w 0 publishes without it; did you mean "
        "'/sad'?\n"
    )
    heard = graph.tap(String, "/said")
    await graph.clock.advance(1.0)
    assert task.result() == exits.OK
    assert list(heard) == [WORD]


async def test_waiting_has_a_limit(graph: Graph, capsys: pytest.CaptureFixture[str]) -> None:
    """If there are too few subscriptions in time, nothing is published, and the exit code is 4."""
    heard = graph.tap(String, "/said")
    task = await begun(graph, PubOptions(wait_matching_subscriptions=2, max_wait_time_secs=3.0))
    await graph.clock.advance(2.9)
    assert not task.done()
    await graph.clock.advance(0.2)
    assert task.result() == exits.TIMEOUT
    assert not heard
    assert capsys.readouterr().err == (
        "1 of 2 nodes subscribe to /said so far; Ctrl-C ends the wait, and -w 0 publishes without it\n"
        "error: /said: fewer than 2 subscriptions after 3 s\n"
    )


@pytest.mark.parametrize(
    ("topic", "way"),
    [
        ("/chater", "did you mean '/chatter'?"),
        ("/a/chatter", "/a/listener subscribes to /chatter: write 'chatter': a slash in front keeps the namespace out"),
    ],
)
async def test_nobody_hears(graph: Graph, capsys: pytest.CaptureFixture[str], topic: str, way: str) -> None:
    """A warning is printed once, with the nearest topic that has subscriptions."""
    node, listener = Node("publishing"), Node("listener", namespace="/a")
    listener.create_subscription(String, "/chatter", lambda _: None)
    await graph.start(node, listener)
    publishing = asyncio.create_task(_publish(node, topic, [Draft(WORD)], PubOptions(rate=10.0)))
    await graph.clock.advance(UNHEARD_AFTER + 3.0)
    publishing.cancel()
    told = capsys.readouterr().err
    assert told.count(f"no node subscribes to {topic} so far; {way}\n") == 1


async def test_it_stays_for_a_while(graph: Graph) -> None:
    """The node stays for a while, so that the last message arrives."""
    graph.tap(String, "/said")
    task = await begun(graph, PubOptions(once=True, keep_alive=2.0))
    await graph.clock.advance(1.9)
    assert not task.done()
    await graph.clock.advance(0.2)
    assert task.done()


@pytest.mark.parametrize(("every", "told"), [(1, [1, 2, 3, 4, 5]), (2, [1, 3, 5]), (NEVER, [])])
async def test_only_some_are_told(
    graph: Graph, capsys: pytest.CaptureFixture[str], every: int, told: list[int]
) -> None:
    """Every N-th, or none; all are sent."""
    heard = graph.tap(String, "/said")
    await begun(graph, PubOptions(times=5, print_every=every))
    await graph.clock.advance(10.0)
    assert len(heard) == 5
    lines = capsys.readouterr().out.splitlines()
    assert [int(line.partition("#")[2].partition(":")[0]) for line in lines if "#" in line] == told


@pytest.mark.parametrize(("options", "told"), [({}, "abc"), ({"times": 2}, "ab"), ({"once": True}, "a")])
async def test_a_series(graph: Graph, options: dict[str, Any], told: str) -> None:
    """Each message is sent once, one after the other, or only the first of them."""
    heard = graph.tap(String, "/said")
    await graph.start(node := Node("_pub"))
    drafts = [Draft(String(data=word)) for word in "abc"]
    task = asyncio.ensure_future(_publish(node, "/said", drafts, PubOptions(**options, is_series=True)))
    await graph.clock.advance(20.0)
    assert task.result() == exits.OK
    assert [message.data for message in heard] == list(told)
