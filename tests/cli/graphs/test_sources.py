"""`graphflow check` of nodes without a graph file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import PROJECT, Machine

NODES = """\
from graphflow import Node, Publisher, timer
from graphflow.msgs.std_msgs.msg import String


class Talker(Node):
    out = Publisher(String, "chatter")

    @timer(1.0)
    async def tick(self) -> None:
        self.out.publish(String())


class Other(Node):
    out = Publisher(String, "chatter")
"""
RCLPY = "from rclpy.node import Node\n\nclass Mover(Node):\n    pass\n"


@pytest.fixture
def here(machine: Machine, tmp_path: Path) -> Machine:
    """A machine with nodes in `nodes/`."""
    (tmp_path / "pyproject.toml").touch()
    for name, text in (("nodes/talk.py", NODES), ("ros/move.py", RCLPY), ("graphs/g.yaml", "nodes: {}\n")):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return machine


@slow
@pytest.mark.parametrize(
    ("path", "told"),
    [
        ("nodes", "nodes: 2 node classes, no problems\n"),
        ("nodes/talk.py", "nodes/talk.py: 2 node classes, no problems\n"),
        ("ros", "ros: no deadlocks visible in the source\n"),
        (".", ".: 2 node classes, no problems; check its graph files one by one: graphs/g.yaml\n"),
    ],
)
def test_source_without_mistakes(here: Machine, tmp_path: Path, path: str, told: str) -> None:
    """The summary counts the nodes checked, of a file or a folder, written for graphflow or rclpy."""
    assert here.look("check", path, cwd=tmp_path) == told


@slow
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("class Other(Node):", "class Other(Node:", "nodes/talk.py:13:17: SyntaxError"),
        ("std_msgs.msg", "std-msgs.msg", "Python imports no name with a hyphen: rename std-msgs to std_msgs"),
        ('(String, "chatter")', '(String, "chat ter")', "'chat ter' is not a topic or service name"),
        ("import String", "import Strang", "package 'std_msgs' has no msg 'Strang'"),
    ],
)
def test_mistakes_in_source(here: Machine, tmp_path: Path, old: str, new: str, told: str) -> None:
    """Files that cannot be read or imported, and wrong declarations, are reported with places and exit code 2."""
    (tmp_path / "nodes/talk.py").write_text(NODES.replace(old, new))
    text = here.look("check", "nodes", cwd=tmp_path, code=2)
    assert told in text
    assert "no problems" not in text
    found = json.loads(here.look("check", "nodes", "--json", cwd=tmp_path, code=2))
    assert told.rpartition(": ")[2] in found["problems"][0]["message"]


@slow
def test_deadlocks_in_source(machine: Machine) -> None:
    """A class that waits for itself needs no graph for that."""
    text = machine.look("check", str(PROJECT / "nodes/deadlock/self_call.py"), code=1)
    assert "CERTAIN: timer tick of /narcissus awaits /narcissus/add" in text
    assert "1 node class, 1 deadlock in the source" in text


def test_a_folder_without_nodes(here: Machine, tmp_path: Path) -> None:
    """Its graph files are named."""
    assert "check its graph files one by one: graphs/g.yaml" in here.look("check", "graphs", cwd=tmp_path, code=2)
    assert here.look("check", "nodes", "graphs/g.yaml", cwd=tmp_path, code=2) == (
        "error: graphs/g.yaml is not source: check it by itself, graphflow check graphs/g.yaml\n"
    )
    (tmp_path / "lamps" / "msg").mkdir(parents=True)
    assert "; graphflow ws checks its interfaces" in here.look("check", "lamps", cwd=tmp_path, code=2)


@pytest.mark.parametrize("verb", ["up", "plan", "launch"])
def test_a_node_where_a_graph_is_wanted(here: Machine, tmp_path: Path, verb: str) -> None:
    """The error says how to run the node and how to write it in a graph file; a node for rclpy runs as a file."""
    text = here.look(verb, "nodes/talk.py", cwd=tmp_path, code=2)
    assert (
        "nodes/talk.py is a node, not a graph file; it has Talker, Other; run it with: graphflow run nodes.talk:Talker"
        in text
    )
    assert "nodes: {/talker: {class: nodes.talk:Talker}}" in text
    assert here.look(verb, "ros/move.py", cwd=tmp_path, code=2).endswith("run it with: graphflow run ros/move.py\n")


@slow
def test_slips_in_source(here: Machine, tmp_path: Path) -> None:
    """Slips are remarks, of a file and of a graph, and do not change the exit code."""
    source = NODES.replace(
        "class Other(Node):", "class Other(Node):\n    def work(self) -> None:\n        self.close\n"
    )
    (tmp_path / "nodes" / "talk.py").write_text(source)
    (tmp_path / "graphs" / "g.yaml").write_text("nodes:\n  /a: {class: nodes.talk:Other}\n")
    said = f"{tmp_path}/nodes/talk.py:15: self.close without parentheses calls nothing; write: self.close()"
    assert here.look("check", "nodes", cwd=tmp_path) == f"{said}\nnodes: 2 node classes, 1 remark\n"
    assert json.loads(here.look("check", "nodes", "--json", cwd=tmp_path))["remarks"] == [said]
    assert json.loads(here.look("check", "graphs/g.yaml", "--json", cwd=tmp_path))["remarks"] == [said]


def test_slips_in_rclpy_source(here: Machine, tmp_path: Path) -> None:
    """They are remarks, too."""
    body = "    def heard(self, message):\n        self.ready.set\n"
    (tmp_path / "ros" / "move.py").write_text(RCLPY.replace("    pass\n", body))
    assert here.look("check", "ros", cwd=tmp_path) == (
        "ros/move.py:5: self.ready.set without parentheses calls nothing; write: self.ready.set()\n"
        "ros: no deadlocks visible in the source, 1 remark\n"
    )


def test_functions_that_rclpy_source_calls_early(here: Machine, tmp_path: Path) -> None:
    """They are remarks, read from the source; a function that is passed is none."""
    body = "    def work(self):\n        self.on = True\n    def __init__(self):\n"
    body += "        Thread(target=rclpy.spin(self)).start()\n        self.create_timer(1.0, self.work())\n"
    body += "        Thread(target=self.work).start()\n"
    (tmp_path / "ros" / "move.py").write_text(RCLPY.replace("    pass\n", body))
    said = [
        "ros/move.py:7: target=rclpy.spin(self) calls rclpy.spin at once, and it does not "
        "return before the program ends; write target=rclpy.spin, args=(self,)",
        "ros/move.py:8: create_timer(..., self.work()) calls work at once, and passes on its result, None; write "
        "self.work",
    ]
    text = "\n".join([*said, "ros: no deadlocks visible in the source, 2 remarks", ""])
    assert here.look("check", "ros", cwd=tmp_path) == text
