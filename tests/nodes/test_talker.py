"""The talker and the listener."""

import logging

import pytest

from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from nodes.listener import Listener
from nodes.talker import Talker


async def test_talker_greets_twice_in_two_seconds(graph: Graph) -> None:
    """At 1 Hz, two seconds bring two greetings, numbered from one."""
    await graph.start(Talker(rate=1.0))
    heard = graph.tap(String, "/chatter")

    await graph.clock.advance(2.0)

    assert [m.data for m in heard] == ["Hello World: 1", "Hello World: 2"]


async def test_a_changed_rate_rearms_the_timer(graph: Graph) -> None:
    """The new rate holds from the moment it is set."""
    talker = Talker(rate=1.0)
    await graph.start(talker)
    heard = graph.tap(String, "/chatter")

    talker.rate = 10.0
    await graph.clock.advance(1.0)

    assert len(heard) == 10


async def test_listener_logs_what_it_hears(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """The listener logs the talker's messages in the format of ROS 2's demo."""
    caplog.set_level(logging.INFO)
    await graph.start(Talker(), Listener())

    await graph.clock.advance(1.0)

    assert "I heard: [Hello World: 1]" in caplog.messages
