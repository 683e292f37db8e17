"""Panes of the console and the names that a graph has."""

from __future__ import annotations

import pytest

from graphflow.console.subjects import subjects
from graphflow.graph.checks.panes import odd_panes
from graphflow.markup import source

KNOWN = {
    "node": {"/talker": "", "/arm/left": ""},
    "topic": {"/chatter": "std_msgs/msg/String", "/cmd": "geometry_msgs/msg/Twist", "/scan1": "", "/odd": "a/msg/Odd"},
    "service": {"/spawn": "turtlesim/srv/Spawn"},
    "action": {"/fibonacci": "example_interfaces/action/Fibonacci"},
}


def told(pane: str) -> list[str]:
    src = source.read(f"console: {{windows: [{{panes: [{pane}]}}]}}", "g.yaml")
    return [str(problem) for _, problem in odd_panes(subjects(src), KNOWN)]


@pytest.mark.parametrize(
    ("pane", "message"),
    [
        ("{log: /talkr}", "this graph has no node /talkr; did you mean '/talker'?"),
        ("{log: talker}", "this graph has no node talker; did you mean '/talker'?"),
        ("{groups: /arm/lefd}", "this graph has no node /arm/lefd; did you mean '/arm/left'?"),
        ("{echo: /chater}", "this graph has no topic /chater; did you mean '/chatter'?"),
        ("{hz: chatter}", "this graph has no topic chatter; did you mean '/chatter'?"),
        ("{plot: /chatter.dat}", "/chatter has no field 'dat'; did you mean 'data'?"),
        ("{plot: '/cmd.linear.x,linear.q'}", "/cmd has no field 'q'; there is x, y, z"),
        ("{calls: /spwan}", "this graph has no service /spwan; did you mean '/spawn'?"),
        ("{goals: /fibonaci}", "this graph has no action /fibonaci; did you mean '/fibonacci'?"),
    ],
)
def test_slips(pane: str, message: str) -> None:
    """Each is reported at its place, with the name that was meant."""
    [line] = told(pane)
    assert line.startswith("g.yaml:1:")
    assert line.endswith(message)


@pytest.mark.parametrize(
    "pane",
    [
        "{log: /talker}, {log: /arm}, {log: /arm/}, {log: /}, {log: /other}, nodes, {turtle: turtle1}",
        "{echo: /chatter}, {echo: /image}, {echo: /scan2}, {hz: /tf}, {graph: /armm}, {source: 'a.py:3'}",
        "{plot: '/cmd.linear.x,angular.z'}, {plot: /scan1.ranges}, {plot: /odd.x}, {plot: /cmd}, {plot: /image.x}",
        "{echo: /chatter/more}, {calls: /talker/get_parameters}, {goals: /dock}, {params: /arm/left}",
    ],
)
def test_what_may_be_meant(pane: str) -> None:
    """Names that the graph has, those of other graphs, and fields of types that are not known here."""
    assert told(pane) == []
