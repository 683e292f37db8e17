"""The listener of the lifecycle demo."""

import logging

import pytest

from graphflow.testing import Graph
from nodes.lifecycle_listener import LifecycleListener
from nodes.lifecycle_talker import LifecycleTalker


async def test_it_hears_the_talker_and_its_transitions(graph: Graph, caplog: pytest.LogCaptureFixture) -> None:
    """In the words of ROS 2's demo."""
    caplog.set_level(logging.INFO)
    talker = LifecycleTalker()
    await graph.start(LifecycleListener(), talker)
    await talker.trigger_configure()
    await talker.trigger_activate()
    await graph.clock.advance(1.0)
    assert "notify callback: from activating to active" in caplog.messages
    assert "data_callback: Lifecycle HelloWorld #1" in caplog.messages
