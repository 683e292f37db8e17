"""`bag play` into a running graph."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from graphflow.msgs.std_msgs.msg import String
from tests.bag.cast import CHATTER, LAB, THING, record, write
from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real


@slow
def test_a_bag_is_heard(machine: Machine, tmp_path: Path) -> None:
    """By whoever listens; its services steer it; Ctrl-C ends it."""
    write(tmp_path / "bag")
    player = machine.start("bag", "play", "bag", "--loop", "-m", "/chatter:=/played", cwd=tmp_path)
    player.wait_for("playing 3 topics of bag.")
    assert "data: hello " in machine.look("topic", "echo", "/played", "std_msgs/msg/String", "--once", "--timeout", "9")
    rate = machine.look("service", "call", "/rosbag2_player/set_rate", "rosbag2_interfaces/srv/SetRate", "{rate: 2.0}")
    assert "success=True" in rate
    assert player.end(signal.SIGINT) == 0, player.text
    assert "played " in player.text


@slow
def test_a_type_that_is_nowhere_installed(machine: Machine, tmp_path: Path) -> None:
    """A type that is not installed is played, and a recorder gets its definition from the player."""
    write(tmp_path / "bag", [record(LAB, THING, 0.0), record(CHATTER, String(), 0.1)])
    recorder = machine.start("bag", "record", "/things", "-o", "again", cwd=tmp_path)
    recorder.wait_for("Recording into again")
    machine.run("bag", "play", "bag", "--topics", "/things", "--delay", "1", cwd=tmp_path)
    recorder.end()
    text = machine.look("bag", "info", "-v", "again", cwd=tmp_path)
    assert "/things | Type: bag_lab_msgs/msg/Thing | Count: 1 |" in text
    assert "  | Part part\n" in text


@slow
def test_a_bag_that_was_not_closed(machine: Machine, tmp_path: Path) -> None:
    """An unclosed bag is played as far as it can be read, with a note."""
    file = write(tmp_path / "bag") / "bag_0.mcap"
    file.write_bytes(file.read_bytes()[:-300])
    text = machine.run("bag", "play", "bag", "-r", "10", "-m", "/chatter:=/played", cwd=tmp_path)
    assert "note: bag was not closed properly; 41 messages can be read" in text
    assert "played 41 messages in" in text
