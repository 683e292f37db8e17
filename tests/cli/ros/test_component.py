"""`graphflow component`, on a running graph."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Iterator

import pytest

from graphflow.runtime.args import RosArgs
from graphflow.supervisor.control.client import ControlClient
from graphflow.supervisor.launching.joining import planned_component
from nodes.listener import Listener
from tests.cases import slow
from tests.conftest import Machine
from tests.supervisor.running import supervisor_of

pytestmark = pytest.mark.real
GRAPH = "tests/programs/supervisor/components.yaml"


@slow
def test_nodes_come_and_go(machine: Machine) -> None:
    """Loading and unloading print ROS 2's lines; a restarted process has the same nodes."""
    machine.run("up", "-d", GRAPH)
    assert machine.look("component", "list") == "tutorial\n  1  /talker\n  2  /listener\n/alone\n  1  /alone\n"
    words = ("-n", "ear", "--node-namespace", "/room", "-r", "chatter:=/news", "--log-level", "WARN")
    assert "Loaded component 3 into 'tutorial' container node as '/room/ear'" in machine.look(
        "component", "load", "tutorial", "composition", "composition::Listener", *words
    )
    assert machine.look("component", "list", "tutorial") == "1  /talker\n2  /listener\n3  /room/ear\n"
    assert machine.look("component", "list", "--containers-only") == "tutorial\n/alone\n"
    assert "/news" in machine.look("node", "info", "/room/ear")
    rows = {row["node"]: row for row in json.loads(machine.look("ps", "--json"))}
    assert rows["/room/ear"]["pid"] == rows["/talker"]["pid"]
    assert machine.look("component", "unload", "/tutorial", "2", "/talker") == (
        "Unloaded component 2 from 'tutorial' container node\nUnloaded component 1 from 'tutorial' container node\n"
    )
    assert machine.look("node", "list") == "/alone\n/room/ear\n"
    machine.look("restart", "/room/ear")
    assert json.loads(machine.look("component", "list", "--json")) == {
        "tutorial": {"1": "/room/ear"},
        "/alone": {"1": "/alone"},
    }
    machine.look("wait", "/room/ear")
    assert "/room/ear" in machine.look("node", "list")


@slow
@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        (("load", "tutorail", "nodes.talker:Talker", "-n", "x"), 1, "no process 'tutorail'; did you mean 'tutorial'?"),
        (("load", "tutorial", "nodes.talker:Talker"), 1, "already in domain"),
        (("load", "tutorial", "nodes.talker:Talker", "-n", "x", "-p", "rat:=1"), 2, "did you mean 'rate'?"),
        (("load", "tutorial", "nodes.talker:Talkr", "-n", "x"), 2, "did you mean 'Talker'?"),
        (("load", "tutorial", "composition", "composition::Talkr"), 2, "did you mean 'talker'?"),
        (("unload", "tutorial", "/taker"), 1, "process 'tutorial' has no node /taker; did you mean '/talker'?"),
        (("unload", "tutorial", "7"), 1, "tutorial has no component 7; there is 1 /talker, 2 /listener"),
        (("unload", "/alone", "1"), 1, "to stop it: graphflow stop /alone"),
        (("list", "/alon"), 1, "did you mean '/alone'?"),
        (("types", "compositon"), 2, "did you mean 'composition'?"),
        (("standalone", "compositon", "b"), 2, "did you mean 'composition'?"),
    ],
)
def test_mistakes(components: Machine, words: tuple[str, ...], code: int, told: str) -> None:
    """Each mistake is an error with a suggestion, and changes nothing."""
    assert told in components.look("component", *words, code=code)


@pytest.fixture(scope="module")
def components(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Machine]:
    """A machine with a running graph."""
    made = Machine(tmp_path_factory.mktemp("components"))
    made.run("up", "-d", GRAPH)
    yield made
    made.close()


@slow
def test_a_process_that_is_stopped_takes_no_order(machine: Machine) -> None:
    """Nothing waits for a stopped process; it carries out the command once it continues."""
    machine.run("up", "-d", GRAPH)
    pid = next(r["pid"] for r in json.loads(machine.look("ps", "--json")) if r["node"] == "/alone")
    ear = planned_component(Listener.interface(), "ear", "/", RosArgs(), "")
    with ControlClient(supervisor_of(machine)["socket"]) as client:
        os.kill(pid, signal.SIGSTOP)
        try:
            client.send(do="load", container="/alone", node=ear.to_json())
            machine.look("component", "load", "tutorial", "nodes.listener:Listener", "-n", "other")
            assert machine.look("component", "list", "tutorial").endswith("3  /other\n")
            assert client.pending() == []
        finally:
            os.kill(pid, signal.SIGCONT)
        assert next(client.receive(20.0)) == {"event": "loaded", "number": 2, "node": "/ear"}


@slow
def test_roses_services_where_the_graph_allows_them(machine: Machine) -> None:
    """ROS 2's own tools load nodes, and `ps` knows of them; other graphs offer no such service."""
    machine.run("up", "-d", "tests/programs/supervisor/controlled.yaml")
    ask = ("service", "call", "/talker/_container/load_node", "composition_interfaces/srv/LoadNode")
    name = "package_name: composition, node_name: ear, node_namespace: /room"
    answer = machine.look(*ask, f"{{{name}, plugin_name: 'composition::Listener', remap_rules: ['chatter:=b']}}")
    assert "full_node_name='/room/ear', unique_id=2" in answer
    assert "/room/ear" in machine.look("ps")
    answer = machine.look(*ask, f"{{{name}, plugin_name: 'composition::Listener'}}")
    assert "success=False, error_message='there is a node /room/ear already'" in answer
    answer = machine.look(*ask, "{package_name: composition, plugin_name: 'composition::Listner'}")
    assert "there is no 'composition::Listner' of the package 'composition' here" in answer
    unload = ("service", "call", "/talker/_container/unload_node", "composition_interfaces/srv/UnloadNode")
    assert "success=False" in machine.look(*unload, "{unique_id: 1}")
    assert "success=True" in machine.look(*unload, "{unique_id: 2}")
    assert "/room/ear" not in machine.look("ps")
    lists = ("service", "call", "/talker/_container/list_nodes", "composition_interfaces/srv/ListNodes")
    assert "full_node_names=['/talker'], unique_ids=array([1])" in machine.look(*lists)


@slow
def test_a_process_of_its_own(machine: Machine) -> None:
    """With ROS 2's options, and its name of the plugin."""
    words = ["component", "standalone", "composition", "composition::Talker", "-n", "t1", "-r", "chatter:=/news"]
    program = machine.start(*words, "-p", "rate:=20.0", "-c", "box")
    program.wait_for("[t1]: Publishing: 'Hello World: 2'")
    assert "/news" in machine.look("topic", "list")
    assert program.end() == 0
