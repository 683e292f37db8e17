"""How names come about."""

from __future__ import annotations

from pathlib import Path

from graphflow.errors import Place
from graphflow.graph.explain import names
from graphflow.graph.resolve import resolve
from graphflow.interface import EndpointInfo, Interface
from graphflow.markup import source

HERE = Place("nodes/robot.py", 7, 5)
ROBOT = Interface(
    "robot:Robot",
    "robot",
    HERE,
    endpoints=(
        EndpointInfo("publisher", "pose", "turtlesim/msg/Pose", "pose", HERE),
        EndpointInfo("subscription", "/clock", "", "clock", HERE),
        EndpointInfo("service", "~/stop", "std_srvs/srv/Trigger", "stop", HERE),
        EndpointInfo("client", "spawn", "turtlesim/srv/Spawn", "spawn", HERE),
    ),
)
TEXT = """\
nodes:
  /lab/r: {class: robot:Robot, params: {rate: 2.0}, remap: {pose: /where}}
  /p: {command: [rviz2]}
steps: {s: {call: /lab/spawn}}
"""


def test_names() -> None:
    """From what a class says to the full name, by namespace and rule; nodes with their parameters, and steps."""
    plan = resolve(source.read(TEXT, "g.yaml"), Path("/nowhere/g.yaml"))
    assert names(plan, {"robot:Robot": ROBOT}) == {
        "/lab/r": ["a node of class robot:Robot, named at g.yaml:2:3", "  its parameter rate is 2.0 (g.yaml:2:47)"],
        "/p": ["the program rviz2, named at g.yaml:3:3"],
        "/where": [
            "/lab/r publishes it as 'pose' (nodes/robot.py:7:5) [turtlesim/msg/Pose]",
            "  pose is /lab/pose, by the namespace /lab (g.yaml:2:3)",
            "  /lab/pose is /where, by the remap pose:=/where (g.yaml:2:61)",
        ],
        "/clock": ["/lab/r subscribes to it as '/clock' (nodes/robot.py:7:5)"],
        "/lab/r/stop": [
            "/lab/r offers it as '~/stop' (nodes/robot.py:7:5) [std_srvs/srv/Trigger]",
            "  ~/stop is /lab/r/stop, by the node's own name (g.yaml:2:3)",
        ],
        "/lab/spawn": [
            "/lab/r calls it as 'spawn' (nodes/robot.py:7:5) [turtlesim/srv/Spawn]",
            "  spawn is /lab/spawn, by the namespace /lab (g.yaml:2:3)",
            "step s has it (call, g.yaml:4:19)",
        ],
    }
