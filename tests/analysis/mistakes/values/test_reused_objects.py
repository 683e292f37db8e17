"""Objects that are appended again and again without being made anew."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.reused_objects import reused_objects

_HANDLER = """
class Trail(Node):
    def __init__(self):
        self.path, self.here = Path(), PoseStamped()

    def located(self, pose):
        {}
"""


@pytest.mark.parametrize(
    ("code", "told"),
    [
        (
            _HANDLER.format("self.here.pose.position.x = pose.x; self.path.poses.append(self.here)"),
            "self.path.poses gets the same self.here each time, so that all of its items show the last change",
        ),
        (
            _HANDLER.format("self.here.pose.position.x = pose.x")
            + "    def publish(self):\n        self.path.poses.append(self.here)\n",
            "self.path.poses gets the same self.here each time",
        ),
        ("point = Point()\nfor x in xs:\n    point.x = x\n    path.points.append(point)", "the same point each time"),
        ("while ok():\n    for x in xs:\n        p.x = x\n        found.append(p)", "the same p each time"),
        ("for x in xs:\n    marker.pose.position.x = x\n    all.append(marker.pose)", "the same marker.pose each time"),
    ],
)
def test_the_same_object_each_time(code: str, told: str) -> None:
    """The sentence names the list and the object, once."""
    [(_, text)] = reused_objects(ast.parse(code))
    assert told in text
    assert text.endswith("append a new one")


@pytest.mark.parametrize(
    "code",
    [
        "for x in xs:\n    point = Point()\n    point.x = x\n    path.points.append(point)",
        "for point in points:\n    point.x = 1\n    path.points.append(point)",
        "for x in xs:\n    path = Path()\n    point.x = x\n    path.points.append(point)\n    publish(path)",
        "for x in xs:\n    point.x = x\n    path.points.append(copy(point))",
        "for x in xs:\n    found.append(point)",
        "for x in xs:\n    if near(x):\n        best.x = x\n        found.append(best)\n        break",
        "for x in xs:\n    if point not in found:\n        point.x = x\n        found.append(point)",
        "for x in xs:\n    try:\n        x()\n    except E as e:\n        e.x = x\n        found.append(e)",
        "while ok():\n    node.parent = last\n    found.append(node)\n    node = node.next",
        _HANDLER.format("self.path.poses.clear(); self.here.x = pose.x; self.path.poses.append(self.here)"),
        _HANDLER.format("self.here.x = pose.x; self.path.append(self.here)\n    def more(self): self.here = Pose()"),
        _HANDLER.format("self.here = pose") + "    def publish(self): self.path.append(self.here)\n",
        _HANDLER.format("here = Pose(); here.x = pose.x; self.path.append(here)"),
    ],
)
def test_objects_that_are_new_or_alone(code: str) -> None:
    """A new object, a copy, an emptied list or a last turn is left alone."""
    assert list(reused_objects(ast.parse(code))) == []
