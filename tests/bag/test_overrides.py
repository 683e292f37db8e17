"""QoS profiles by topic."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from graphflow.bag.overrides import read
from graphflow.errors import UsageFault
from graphflow.qos import Durability, History, Qos, Reliability


def test_a_file_as_ros_has_it(tmp_path: Path) -> None:
    """Policies that are left out are the defaults."""
    file = tmp_path / "qos.yaml"
    file.write_text(
        """
/pose:
  reliability: best_effort
  history: keep_all
/map:
  durability: transient_local
  depth: 1
  deadline: {sec: 1, nsec: 500}
  liveliness: automatic
  avoid_ros_namespace_conventions: false
"""
    )
    assert read(file) == {
        "/pose": Qos(reliability=Reliability.BEST_EFFORT, history=History.KEEP_ALL),
        "/map": Qos(durability=Durability.TRANSIENT_LOCAL, depth=1, deadline_ns=1_000_000_500),
    }


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("[", "node content"),
        ("5", "it has no topics"),
        ("/a: best_effort", "/a: a profile has policies"),
        ("/a: {reliabilty: best_effort}", "there is no policy 'reliabilty'; did you mean 'reliability'?"),
        ("/a: {reliability: good}", "reliability: 'good' is not one of"),
        ("/a: {depth: -1}", "depth: -1 is not a number of messages"),
        ("/a: {depth: true}", "depth: True is not a number of messages"),
        ("/a: {deadline: 1}", "deadline: 1 is not a duration; write {sec: 1, nsec: 0}"),
        ("/a: {deadline: {sec: 99999999999}}", "is not a duration"),
        ("/a//b: {depth: 1}", "/a//b"),
        ("a: {depth: 1}", "a:"),
        ("/a: &x {depth: 1}\n/b: *x", "it has aliases"),
    ],
)
def test_what_is_wrong(tmp_path: Path, text: str, told: str) -> None:
    """Is told with its place."""
    file = tmp_path / "qos.yaml"
    file.write_text(text)
    with pytest.raises(UsageFault) as caught:
        read(file)
    assert str(file) in str(caught.value)
    assert told in str(caught.value)


def test_a_file_that_is_too_large(tmp_path: Path) -> None:
    """Is refused, not cut."""
    file = tmp_path / "qos.yaml"
    file.write_text("/a: {depth: 1}\n" + "#" * (1 << 20) + "\n/b: {depth: 1}\n")
    with pytest.raises(UsageFault, match="it has more than 1,048,576 bytes"):
        read(file)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no FIFOs")
def test_a_fifo(tmp_path: Path) -> None:
    """Is refused: nobody may ever write to it."""
    os.mkfifo(tmp_path / "qos.yaml")
    with pytest.raises(UsageFault, match="it is not a regular file"):
        read(tmp_path / "qos.yaml")


def test_no_file(tmp_path: Path) -> None:
    """Says so."""
    with pytest.raises(UsageFault, match="No such file or directory"):
        read(tmp_path / "none.yaml")
