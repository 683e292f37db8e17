"""Comparisons that never hold."""

from __future__ import annotations

import ast

import pytest

from graphflow import LifecycleNode, Node, Param, Publisher
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.mistakes.source.never_equal import never_equal

BODY = """
class Robot(Node):
    async def drive(self, other):
        sent = await self.goals.send_goal(Fibonacci.Goal())
        self.goal = await self.goals.send_goal(Fibonacci.Goal())
        async with self.goals.send(Fibonacci.Goal()) as goal:
            {}
"""


class Robot(Node):
    """The class that the lines belong to."""

    enabled = Param(True)
    rate = Param(1.0)
    count = Param(1)
    frame = Param("map")
    tags = Param(["a"])
    mode = Param("fast", choices=["fast", "slow"])


class Slower(Robot):
    """A class with other choices."""

    mode = Param("slow", choices=["slow", "slower"])


def _told(line: str, cls: type[Node] = Robot) -> list[str]:
    module = ast.parse(BODY.format(line))
    (definition,) = module.body
    assert isinstance(definition, ast.ClassDef)
    return [text for _, text in never_equal(cls, Robot, definition, module)]


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("self.enabled == 'true'", "self.enabled is a bool, which never equals 'true'; write self.enabled"),
        ("'False' != self.enabled", "self.enabled is a bool, which never equals 'False'; write self.enabled"),
        ("self.enabled == 'false'", "self.enabled is a bool, which never equals 'false'; write not self.enabled"),
        ("self.enabled in ('true', 'on')", "self.enabled is a bool, which never equals 'true' or 'on'"),
        ("self.rate == '2.0'", "self.rate is a float, which never equals '2.0'; write 2.0 without quotes"),
        ("self.count == 'many'", "self.count is an int, which never equals 'many'"),
        ("self.mode == 'Fast'", "self.mode is 'fast' or 'slow', and never 'Fast'; did you mean 'fast'?"),
        (
            "self.parameters.get('mode') != 'sloow'",
            "self.parameters.get('mode') is 'fast' or 'slow', and never 'sloow'",
        ),
        ("self.mode in ['FAST', 'SLOW']", "self.mode is 'fast' or 'slow', and never 'FAST' or 'SLOW'"),
        ("match self.mode:\n                case 'Fast': pass", "self.mode is 'fast' or 'slow', and never 'Fast'"),
        ("self.frame == 1", "self.frame is a str, which never equals 1; compare it with a text, in quotes"),
        (
            "goal.status == 'SUCCEEDED'",
            "goal.status is a GoalStatus, which never equals 'SUCCEEDED'; write goal.status is GoalStatus.SUCCEEDED",
        ),
        (
            "sent.status != 'STATUS_ABORTED'",
            "sent.status is a GoalStatus, which never equals 'STATUS_ABORTED'; write sent.status is not "
            "GoalStatus.ABORTED",
        ),
        (
            "self.goal.status == 'done'",
            "self.goal.status is a GoalStatus, which never equals 'done'; write self.goal.status is GoalStatus.",
        ),
    ],
)
def test_comparisons_that_never_hold(line: str, told: str) -> None:
    """Each is told with the comparison that was meant, where that is clear."""
    (text,) = _told(line)
    assert text.startswith(told)


@pytest.mark.parametrize(
    "line",
    [
        "self.enabled == True",
        "self.enabled == 1",
        "self.rate == 2",
        "self.mode == 'slow'",
        "self.mode in ('fast', 'turbo')",
        "self.mode == other",
        "self.mode == ''",
        "self.frame == 'odom'",
        "self.frame == None",
        "self.tags == ['a']",
        "other.enabled == 'true'",
        "str(self.enabled) == 'True'",
        "goal.status.name == 'SUCCEEDED'",
        "goal.status == 4",
        "other.status == 'SUCCEEDED'",
        "self.goals.status == 'SUCCEEDED'",
        "sent = other\n            sent.status == 'SUCCEEDED'",
    ],
)
def test_comparisons_that_may_hold(line: str) -> None:
    """Values of the type, choices that exist, and whatever has a text for its status."""
    assert _told(line) == []


def test_a_subclass_with_other_choices() -> None:
    """Its parent's comparisons are made for both."""
    assert _told("self.mode == 'slower'", Slower) == []


class Arm(LifecycleNode):
    """A node with managed states."""


def test_the_state_of_a_lifecycle_node() -> None:
    """It is no text; an attribute of that name may be."""
    (text,) = _told("self.lifecycle_state == 'active'", Arm)
    assert text.endswith(
        "is a LifecycleState, which never equals 'active'; write self.lifecycle_state is LifecycleState.ACTIVE"
    )
    assert _told("self.lifecycle_state == 'active'") == []


class Sensor(Node):
    """A node that is told about the events of its endpoints."""

    def missed(self, event: object) -> None:
        """Be called with an event."""

    out = Publisher(String, "out", on_event=missed)


@pytest.mark.parametrize(
    ("method", "kind", "told"),
    [
        (
            "def missed(self, event)",
            "requested_deadline_missed",
            "event.kind is never 'requested_deadline_missed'; did",
        ),
        ("def other(self, event: QosEvent)", "deadline", "event.kind is never 'deadline'; "),
        ("def missed(self, event)", "deadline_missed", ""),
        ("def other(self, event)", "requested_deadline_missed", ""),
    ],
)
def test_the_kind_of_an_event(method: str, kind: str, told: str) -> None:
    """It is one of a few words; other arguments may have a kind of their own."""
    module = ast.parse(f"class Sensor(Node):\n    {method}:\n        return event.kind == {kind!r}")
    (definition,) = module.body
    assert isinstance(definition, ast.ClassDef)
    found = [text for _, text in never_equal(Sensor, Sensor, definition, module)]
    assert [text.startswith(told) for text in found] == ([True] if told else [])
