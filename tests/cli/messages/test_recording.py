"""`bag record` on a running graph: ended, killed, with a full disk."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from graphflow.bag.reader import Bag
from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real

CHATTER = "std_msgs/msg/String"


def talk(machine: Machine) -> None:
    machine.start("run", "nodes.talker:Talker").wait_for("Publishing: 'Hello World: 1'")


@slow
def test_recording_and_playing(machine: Machine, tmp_path: Path) -> None:
    """Published messages are in the bag after Ctrl-C, and `play` publishes them again."""
    talk(machine)
    recorder = machine.start("bag", "record", "/chatter", "/rosout", "-o", "bag", cwd=tmp_path)
    recorder.wait_for("Subscribed to topic '/chatter'")
    machine.look("topic", "echo", "/chatter", "--once")
    assert recorder.end(signal.SIGINT) == 0, recorder.text
    assert "Recording into bag" in recorder.text
    assert "WARNING" not in recorder.text
    bag = Bag(tmp_path / "bag")
    assert bag.contents.is_whole
    count = bag.contents.counts["/chatter"]
    assert count >= 1
    assert f"Recording stopped: {bag.contents.message_count:,} messages of 2 topics in" in recorder.text
    assert bag.contents.topics["/chatter"].definition == "string data\n"

    words = ("bag", "play", "bag", "--topics", "/chatter", "-m", "/chatter:=/again", "-r", "10", "--delay", "0.1")
    assert f"played {count} messages in" in machine.run(*words, cwd=tmp_path)


@slow
def test_a_recorder_that_is_killed(machine: Machine, tmp_path: Path) -> None:
    """Leaves what it wrote half a second ago, and before."""
    talk(machine)
    recorder = machine.start("bag", "record", "-a", "-o", "bag", cwd=tmp_path)
    recorder.wait_for("Subscribed to topic '/chatter'")

    def some_are_there() -> bool:
        return (tmp_path / "bag" / "bag_0.mcap").exists() and Bag(tmp_path / "bag").contents.message_count > 1

    machine.until(some_are_there, "messages are on the disk")
    os.kill(recorder.pid, signal.SIGKILL)
    recorder.wait()
    bag = Bag(tmp_path / "bag")
    assert len(list(bag.records())) == bag.contents.message_count > 1
    assert not bag.contents.is_whole
    text = machine.look("bag", "recover", "bag", cwd=tmp_path)
    assert text.startswith(f"bag_recovered: {bag.contents.message_count} messages of ")


@slow
def test_the_services_of_the_recorder(machine: Machine, tmp_path: Path) -> None:
    """Pause, resume and split, as ROS 2's has them."""
    talk(machine)
    recorder = machine.start("bag", "record", "/chatter", "-o", "bag", "--node-name", "scribe", cwd=tmp_path)
    recorder.wait_for("Subscribed to topic '/chatter'")
    for verb in ("pause", "resume"):
        type_name = f"rosbag2_interfaces/srv/{verb.title()}"
        machine.look("service", "call", f"/scribe/{verb}", type_name)
        asked = machine.look("service", "call", "/scribe/is_paused", "rosbag2_interfaces/srv/IsPaused")
        assert f"paused={verb == 'pause'}" in asked
    machine.look("service", "call", "/scribe/split_bagfile", "rosbag2_interfaces/srv/SplitBagfile")
    machine.until(lambda: len(list((tmp_path / "bag").glob("*.mcap"))) == 2, "there are two files")
    asked = machine.look("service", "call", "/scribe/snapshot", "rosbag2_interfaces/srv/Snapshot")
    assert "success=False" in asked
    assert recorder.end(signal.SIGTERM) == 0
    assert Bag(tmp_path / "bag").contents.is_whole


@slow
def test_for_some_time(machine: Machine, tmp_path: Path) -> None:
    """A recording with a duration ends by itself; a topic without publishers is reported."""
    text = machine.run("bag", "record", "/nobody", "--duration", "0.5", "-o", "bag", cwd=tmp_path, code=1)
    assert "WARNING: topic [/nobody] does not appear to be published yet" in text
    assert "no topic appeared to be recorded; `graphflow topic list` shows all topics" in text


@slow
def test_the_name_of_a_bag_without_its_option(machine: Machine, tmp_path: Path) -> None:
    """It is taken for a topic, which is told beside the topic that is recorded; so is what to write."""
    (tmp_path / "bags").mkdir()
    text = machine.look("bag", "record", "./walk", "/chatter", cwd=tmp_path, code=2)
    assert text.endswith("; if it is the bag to be written, write -o ./walk\n")
    talker = machine.start("run", "nodes.talker:Talker")
    talker.wait_for("Publishing")
    text = machine.run("bag", "record", "walk", "/chatter", "--duration", "2.5", cwd=tmp_path, code=0)
    assert "note: /walk is recorded; if walk is the name of the bag, write -o walk" in text
    assert "/rosout; if walk is the name of the bag, write -o walk" in text
    text = machine.run("bag", "record", "bags/walk", "/chatter", "--duration", "2.5", cwd=tmp_path, code=0)
    assert "; if bags/walk is the name of the bag, write -o bags/walk" in text
    assert "write -o" not in machine.run("bag", "record", "/walk", "--duration", "0.5", "-o", "b", cwd=tmp_path, code=1)
    assert talker.end(signal.SIGINT) == 0


@slow
def test_a_domain_without_nodes(machine: Machine, tmp_path: Path) -> None:
    """Another domain with nodes is suggested, as by `topic hz`."""
    other = str(machine.domain + 1)
    talker = machine.start("--domain", other, "run", "nodes.talker:Talker")
    talker.wait_for("Publishing")
    told = f"no nodes in domain {machine.domain}; there is 1 node in domain {other}: graphflow --domain {other} ..."
    assert told in machine.run("bag", "record", "-a", "--duration", "4", "-o", "bag", cwd=tmp_path, code=1)
    rates = machine.start("topic", "hz", "/chatter")
    rates.wait_for(told)
    rates.end()
    assert talker.end() == 0


def test_types_without_their_package(machine: Machine) -> None:
    """Nothing could be of such a type."""
    told = machine.look("bag", "record", "--topic-types", "String", code=2)
    assert "'String' is not an interface name; did you mean " in told


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk with room for little more than what a recorder keeps free."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=5m", "tmpfs", str(folder)]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("this user may not mount a disk")
    yield folder
    subprocess.run(["umount", "-l", str(folder)], check=True)


@slow
def test_a_full_disk(machine: Machine, small_disk: Path) -> None:
    """A full disk ends the recording with its reason; the bag is complete up to then."""
    recorder = machine.start("bag", "record", "/big", "--compression", "none", "-o", "bag", cwd=small_disk)
    recorder.wait_for("Recording into bag")
    payload = "x" * 20_000
    speaker = machine.start("topic", "pub", "/big", CHATTER, f"data: {payload}", "-r", "100", "-p", "1000")
    assert recorder.wait(20.0) == 1, recorder.text
    speaker.end()
    assert "error: bag: the disk is full; what has been recorded can be read" in recorder.text
    bag = Bag(small_disk / "bag")
    assert bag.contents.is_whole
    assert len(list(bag.records())) == bag.contents.message_count > 10


def test_a_node_name_that_is_none(machine: Machine, tmp_path: Path) -> None:
    """Leaves no folder behind."""
    words = ("bag", "record", "-a", "-o", str(tmp_path / "bag"), "--node-name", "a-b")
    assert "a-b" in machine.look(*words, code=None)
    assert not (tmp_path / "bag").exists()
