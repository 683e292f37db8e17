"""graphflow's nodes, as rclpy's hold them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from graphflow.errors import GraphFileError
from graphflow.names import Resolver
from graphflow.rclpy import node_bridge
from graphflow.rclpy.context_state import LOOP, ContextState, parse_only_ros
from graphflow.rclpy.node_bridge import Mark, NodeBell
from graphflow.runtime.node_core import core_of
from graphflow.transport.inbox import Inbox


def test_a_bell_wakes_the_executor_and_tells_the_inboxes_that_have_rung() -> None:
    """Once for a burst; what comes while nobody listens is not lost."""

    class Executor:
        woken = 0

        def wake(self) -> None:
            self.woken += 1

    bell, executor, told = NodeBell(), Executor(), list[str]()
    inbox = Inbox(bell, None, lambda: told.append("inbox"))
    inbox.put(1)
    bell.executor = lambda: executor
    inbox.put(2)
    other = Inbox(bell, None, lambda: told.append("other"))
    other.put(3)
    bell.mark("guard")
    assert executor.woken == 1  # the bell had rung before, unheard
    bell.attend()
    assert told == ["inbox", "other"]
    assert list(bell.ready) == ["guard"]
    inbox.put(4)
    assert executor.woken == 2


def test_a_mark_signals_an_entity_that_exists() -> None:
    """Arrivals before that are found when it is added."""
    bell = NodeBell()
    mark = Mark(bell)
    mark()
    assert not bell.ready
    mark.entity = "subscription"
    mark()
    assert list(bell.ready) == ["subscription"]


def test_a_node_and_its_endpoints_are_in_the_graph_at_once() -> None:
    """And gone at once; withdrawing twice is harmless."""
    life = ContextState([], 0)
    node = node_bridge.open_node(life, "one", "/ns", [], rosout=False)
    cache = core_of(node).context.cache
    assert cache.nodes() == ["/ns/one"]
    LOOP.call(node_bridge.describe_types, node)
    node_bridge.close_node(node)
    assert cache.nodes() == []
    node_bridge.close_node(node)
    life.close()


def test_parameters_of_the_command_line_and_of_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """For this node by its name, or for all; those of a graph have their places; a file that is none is an error."""
    file = tmp_path / "params.yaml"
    file.write_text("/ns/one: {ros__parameters: {rate: 2, a: {b: x}}}\n/other: {ros__parameters: {rate: 3}}\n")
    words = ["--ros-args", "--params-file", str(file), "-p", "one:gain:=1.5", "-p", "two:gain:=9", "-p", "all:=true"]
    found = node_bridge.overrides_for(parse_only_ros(words), Resolver("one", "/ns", []))
    assert {name: value for name, (value, _) in found.items()} == {"rate": 2, "a.b": "x", "gain": 1.5, "all": True}
    places = {"all": [True, "t.launch.xml:3"], "gain": [2.5, "t.launch.xml:4"]}
    monkeypatch.setenv("GRAPHFLOW_PARAM_PLACES", json.dumps(places))
    found = node_bridge.overrides_for(parse_only_ros(words), Resolver("one", "/ns", []))
    assert (found["all"], found["gain"]) == ((True, "t.launch.xml:3"), (1.5, "command line"))
    file.write_text("[]")
    with pytest.raises(GraphFileError):
        node_bridge.overrides_for(parse_only_ros(words), Resolver("one", "/ns", []))
