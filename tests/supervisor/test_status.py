"""The states of a graph as topics and services."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.msgs.diagnostic_msgs.msg import DiagnosticArray
from graphflow.msgs.diagnostic_msgs.srv import SelfTest
from graphflow.supervisor.processes.process import Process
from graphflow.supervisor.status import Mirror
from graphflow.testing import Graph
from tests.cases import slow
from tests.conftest import Machine
from tests.supervisor.control.test_components import node


def row(name: str, state: str, **more: Any) -> Any:
    return {**Process(name, [node(name)], "log").rows()[0], "state": state, **more}


async def test_states_are_published_and_answered(graph: Graph) -> None:
    """Each node with its level, its state in words, and what else `ps` knows."""
    rows = [row("/a", "ready", pid=7), row("/b", "given_up", detail="exit code 3"), row("/c", "waiting")]
    mirror = Mirror("my-graph", lambda: rows)
    await graph.start(mirror)
    heard = graph.tap(DiagnosticArray, "/my_graph/_supervisor/states")
    mirror.publish_states()
    await graph.settle()
    found = {s.name: (s.level, s.message) for s in heard.latest.status}
    assert found == {"/a": (0, "ready"), "/b": (2, "given_up"), "/c": (1, "waiting")}
    values = [{v.key: v.value for v in s.values} for s in heard.latest.status]
    assert values[0] == {"pid": "7", "class": "nodes.talker:Talker", "restarts": "0"}
    assert values[1]["detail"] == "exit code 3"
    answer = await graph.call(SelfTest, "/my_graph/_supervisor/get_states", SelfTest.Request())
    assert (answer.id, answer.passed, len(answer.status)) == ("my-graph", 0, 3)
    del rows[1:]
    answer = await graph.call(SelfTest, "/my_graph/_supervisor/get_states", SelfTest.Request())
    assert answer.passed == 1


@pytest.mark.parametrize(
    ("graph_name", "name"),
    [
        ("a.b", "/a_b/_supervisor"),
        ("20", "/_20/_supervisor"),
        ("a--b_c", "/a_b_c/_supervisor"),
        ("caf\u00e9", "/caf_/_supervisor"),
        ("_x", "/_x/_supervisor"),
    ],
)
def test_any_name_of_a_graph_gives_a_legal_one(graph_name: str, name: str) -> None:
    """Graphs may be called by more than nodes may."""
    assert Mirror(graph_name, list).full_name == name


@slow
@pytest.mark.real
def test_a_running_graph_is_mirrored(machine: Machine) -> None:
    """A late subscription gets the states, and a change is told; the node does not show unless it is asked for."""
    machine.run("up", "-d", "graphs/talker_listener.yaml")
    topic = "/talker_listener/_supervisor/states"
    machine.until(lambda: topic in machine.look("topic", "list", "--include-hidden-topics"), "the mirror")
    assert "_supervisor" not in machine.look("node", "list")
    assert "message: ready" in machine.look("topic", "echo", topic, "--once")
    machine.look("stop", "/listener")
    machine.until(lambda: "message: ended" in machine.look("topic", "echo", topic, "--once"), "the change")
