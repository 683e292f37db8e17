"""Recordings: a file that Rerun opens, with a layout, times and frames; from a graph, and from a bag."""

from __future__ import annotations

from pathlib import Path

import pytest

rr = pytest.importorskip("rerun", reason="the extra `rerun` is not installed")

from graphflow import Time
from graphflow.errors import UsageFault
from graphflow.msgs.geometry_msgs.msg import PoseStamped
from graphflow.msgs.std_msgs.msg import Header, String
from graphflow.msgs.tf2_msgs.msg import TFMessage
from graphflow.tf import Transform
from graphflow.viewer.rerun.recording import Recording, layout


def test_a_file(tmp_path: Path) -> None:
    """It has what was logged; the fixed frame is the best that is known."""
    recording = Recording("lab")
    recording.open(tmp_path / "a.rrd")
    stamp = Time(3 * 10**9)
    for parent, child in (("odom", "base"), ("map", "odom"), ("world", "moon")):
        message = TFMessage(transforms=[Transform.of(parent, child, stamp=stamp).to_msg()])
        recording.add("/tf", "tf2_msgs/msg/TFMessage", message, 10**18)
    pose = PoseStamped(header=Header(frame_id="odom", stamp=stamp))
    recording.add("/goal", "geometry_msgs/msg/PoseStamped", pose, 10**18)
    recording.add("/said", "std_msgs/msg/String", String(data="hello"), 10**18)
    recording.close()
    assert recording._fixed == "map"
    assert recording._frames == {"goal": "odom"}
    assert (tmp_path / "a.rrd").stat().st_size > 1000
    assert (tmp_path / "a.rrd").read_bytes()[:3] == b"RRF"


def test_a_file_that_cannot_be_written(tmp_path: Path) -> None:
    """The error says why."""
    with pytest.raises(UsageFault, match=r"cannot write .*nowhere/a\.rrd"):
        Recording("lab").open(tmp_path / "nowhere" / "a.rrd")


def test_layouts() -> None:
    """One with and one without a fixed frame."""
    assert layout("").root_container is not None
    assert layout("map").root_container is not None
