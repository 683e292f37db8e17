"""Transforms and frames as text."""

from __future__ import annotations

import math

from graphflow import Time
from graphflow.tf import FrameInfo, Transform
from graphflow.tf.text import described, monitored, remark, tree

ODOM = FrameInfo(
    "odom", "map", "/slam", is_static=False, rate=30.0, newest=Time(0), delay=0.01, longest_delay=0.2, silent=0.0
)
LASER = FrameInfo(
    "laser", "odom", "", is_static=True, rate=0.0, newest=Time(0), delay=0.0, longest_delay=0.0, silent=0.0
)


def test_a_transform() -> None:
    """The form is that of tf2_echo."""
    turned = Transform.of("map", "base", (1.0, 2.0, 0.0), rpy=(0.0, 0.0, math.pi / 2), stamp=Time(7_000_000_005))
    lines = described(turned).splitlines()
    assert lines[:2] == ["At time 7.000000005", "- Translation: [1.000, 2.000, 0.000]"]
    assert lines[4] == "- Rotation: in RPY (degree) [0.000, -0.000, 90.000]"
    assert lines[6:] == [
        "  0.000 -1.000  0.000  1.000",
        "  1.000  0.000  0.000  2.000",
        "  0.000  0.000  1.000  0.000",
        "  0.000  0.000  0.000  1.000",
    ]


def test_trees() -> None:
    """Each tree has its root and its branches, also one that is a loop."""
    drawn = tree({"odom": "map", "base": "odom", "arm": "base", "laser": "base"}, {"odom": "30 Hz"})
    assert drawn == ["map", "└── odom   (30 Hz)", "    └── base", "        ├── arm", "        └── laser"]
    assert tree({"a": "r", "b": "s"}, {}) == ["r", "└── a", "s", "└── b"]
    assert tree({"a": "b", "b": "a"}, {})[0] == "a"
    assert tree({}, {}) == []


def test_remarks() -> None:
    """Rate, age and publisher are named where there are any."""
    assert remark(ODOM, 0.021) == "30.0 Hz, 0.02 s old, by /slam"
    assert remark(ODOM, 1.7e9) == f"30.0 Hz, at {ODOM.newest.seconds:.2f} s, by /slam"
    assert remark(LASER, 5.0) == "static, its publisher has ended"


def test_summaries() -> None:
    """The form is that of tf2_monitor, for a chain and for all frames."""
    assert monitored([LASER, ODOM], ["map", "odom"], [0.1, 0.3]).splitlines() == [
        "RESULTS: for map to odom",
        "Chain is: map -> odom",
        "Net delay     avg = 0.2: max = 0.3",
        "",
        "Frames:",
        "Frame: odom, published by /slam, Average Delay: 0.01, Max Delay: 0.2",
        "",
        "All Broadcasters:",
        "Node: <ended> 0 Hz, Average Delay: 0 Max Delay: 0",
        "Node: /slam 30 Hz, Average Delay: 0.01 Max Delay: 0.2",
    ]
    assert monitored([LASER], [], []).splitlines()[:4] == [
        "RESULTS: for all Frames",
        "",
        "Frames:",
        "Frame: laser, published by <ended>, static",
    ]
