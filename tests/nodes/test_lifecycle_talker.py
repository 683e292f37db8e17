"""The lifecycle talker and its listener."""

import logging

import pytest

from graphflow.msgs.std_msgs.msg import String
from graphflow.testing import Graph
from nodes.lifecycle_talker import LifecycleTalker


async def test_it_talks_only_while_active(graph: Graph) -> None:
    """It counts on after a pause, and from one after a cleanup."""
    talker = LifecycleTalker()
    await graph.start(talker)
    heard = graph.tap(String, "/lifecycle_chatter")
    for step in ("configure", "activate", "deactivate", "activate", "deactivate", "cleanup", "configure", "activate"):
        await getattr(talker, f"trigger_{step}")()
        await graph.clock.advance(1.5)
    assert [m.data[-2:] for m in heard] == ["#1", "#2", "#1"]


async def test_the_diary_is_closed_by_cleanup(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """Context managers of `on_configure` exit in `cleanup`, after the hook has used them."""
    caplog.set_level(logging.INFO)
    talker = LifecycleTalker()
    await graph.start(talker)
    for step in ("configure", "activate"):
        await getattr(talker, f"trigger_{step}")()
    await graph.clock.advance(2.5)
    for step in ("deactivate", "cleanup"):
        await getattr(talker, f"trigger_{step}")()
    assert "on_cleanup() is called after 2 greetings." in caplog.messages
    assert talker.diary.closed
