"""`topic hz`, `bw` and `delay`, of nodes in other processes."""

from __future__ import annotations

import json
import re
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from graphflow.cli.messages.measuring import TYPES_BOUND, _listen_to_all
from graphflow.errors import UsageFault
from tests.cases import slow
from tests.conftest import Machine

NODE = """
from graphflow import Node, Param, Publisher, timer
from graphflow.msgs.{package}.msg import Thing

class Things(Node):
    things = Publisher(Thing, "things")
    rate = Param(100.0)
    count = 0

    @timer(hz=rate)
    def tick(self):
        self.count += 1
        thing = Thing(x=self.count % 2)
        now = self.clock.time_ns()
        thing.header.stamp.sec, thing.header.stamp.nanosec = divmod(now - 50_000_000, 10**9)
        self.things.publish(thing)
"""


@pytest.fixture(scope="module")
def things(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Machine]:
    """A machine on which a node publishes 100 messages a second, of a type that is only in its own project."""
    root = tmp_path_factory.mktemp("things")
    (root / "nodes").mkdir()
    (root / "pyproject.toml").touch()
    (root / "nodes" / "things.py").write_text(NODE.format(package="measured_msgs"))
    folder = root / "interfaces" / "measured_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Thing.msg").write_text("std_msgs/Header header\nuint8 x\nPart part\n")
    (folder / "Part.msg").write_text("float64[3] position\n")
    (root / "g.yaml").write_text("nodes: {/things: {class: nodes.things:Things}}\n")
    machine = Machine(root)
    machine.run("up", "-d", "g.yaml", cwd=root)
    yield machine
    machine.close()


def heard_of(announced: list[tuple[str, str]], broken: str = "") -> list[str]:
    """Return the types with which a topic is listened to; `broken` cannot be measured."""
    heard = []

    def listen(topic: str, type_name: str, type_hash: str) -> None:
        if type_name == broken:
            raise UsageFault(f"{topic}: {type_name} is not known")
        heard.append(type_name)

    _listen_to_all("/t", announced, listen)
    return heard


def test_a_topic_of_several_types(capsys: pytest.CaptureFixture[str]) -> None:
    """Each is measured, and a warning names them; one that cannot be measured does not hide the others."""
    assert heard_of([("a", "1"), ("b", "2"), ("a", "1")], broken="a") == ["b"]
    told = capsys.readouterr().err
    assert "/t is published with several types, and all are measured: a and b" in told
    assert "WARNING: /t: a is not known" in told
    with pytest.raises(UsageFault, match="a is not known"):
        heard_of([("a", "1"), ("a", "1")], broken="a")
    assert capsys.readouterr().err == ""


def test_no_more_types_than_the_bound() -> None:
    """Anybody may announce types."""
    assert len(heard_of([(f"t{i}", "") for i in range(TYPES_BOUND + 3)])) == TYPES_BOUND


def watch(machine: Machine, *words: str, until: str) -> str:
    program = machine.start("topic", *words, cwd=Path("/"))
    text = program.wait_for(until)
    assert program.end(signal.SIGINT) == 0, program.text
    return text


@slow
@pytest.mark.real
def test_a_type_that_is_only_there(things: Machine) -> None:
    """Its definition comes from the node; it is looked at, measured and published like any other."""
    text = things.run("topic", "echo", "/things", "--once", cwd=Path("/"))
    assert "part:\n  position:\n  - 0.0\n" in text
    words = ("pub", "/things", "measured_msgs/msg/Thing", "{x: 9}", "--once", "-w", "0")
    assert "measured_msgs.msg.Thing" in things.run("topic", *words, cwd=Path("/"))
    assert things.run("topic", "type", "/things", cwd=Path("/")) == "measured_msgs/msg/Thing\n"


@slow
@pytest.mark.real
def test_hz(things: Machine) -> None:
    """The rate of messages is printed in ROS 2's format."""
    text = watch(things, "hz", "/things", until="window: 1")
    found = re.search(
        r"average rate: (\d+\.\d{3})\n\tmin: \d\.\d{3}s max: \d\.\d{3}s std dev: \d\.\d{5}s window: \d+", text
    )
    assert found is not None
    assert 50 < float(found[1]) < 200


@slow
@pytest.mark.real
def test_a_single_message(things: Machine) -> None:
    """Has no rate, and makes no line."""
    program = things.start("topic", "hz", "/once", cwd=Path("/"))
    program.wait_for("topic [/once] does not appear to be published yet")
    words = ("topic", "pub", "/once", "std_msgs/msg/String", "data: x", "--once", "--keep-alive", "1.5")
    things.run(*words, cwd=Path("/"))
    program.wait_for("no new messages")
    program.end()
    assert "\n\n" not in program.text


@slow
@pytest.mark.real
def test_hz_of_some_and_of_several(things: Machine) -> None:
    """Only messages that fit, of a type that was learned; several topics in a table."""
    text = watch(things, "hz", "/things", "--filter", "m.x == 1", until="average rate")
    assert 25 < float(text.split("average rate: ")[1].split()[0]) < 100
    text = watch(things, "hz", "/things", "/rosout", until="/things")
    assert "topic    rate" in text


@slow
@pytest.mark.real
def test_bw(things: Machine) -> None:
    """Payload bytes."""
    text = watch(things, "bw", "/things", until="Message size")
    assert text.startswith("Subscribed to [/things]\n")
    assert re.search(r"\d KB/s from \d+ messages\n\tMessage size mean: 0\.0\d KB min", text)


@slow
@pytest.mark.real
def test_delay(things: Machine) -> None:
    """By the stamp in the header."""
    text = watch(things, "delay", "/things", until="average delay")
    assert 0.04 < float(text.split("average delay: ")[1].split()[0]) < 1.0


@slow
@pytest.mark.real
def test_what_cannot_be_measured(things: Machine) -> None:
    """The error says why; a missing topic is waited for, and the nearest one is suggested."""
    assert "has no header, so no stamp from which a delay could be measured" in things.run(
        "topic", "delay", "/rosout", code=2
    )
    assert "AttributeError" in things.run("topic", "hz", "/things", "--filter", "m.y", code=2, cwd=Path("/"))
    watch(things, "hz", "/thing", until="topic [/thing] does not appear to be published yet; did you mean '/things'?")


@slow
@pytest.mark.real
@pytest.mark.parametrize(
    ("words", "number"),
    [("hz /things /rosout", "rate"), ("bw /things", "bytes_per_second"), ("delay /things", "delay")],
)
def test_for_programs(things: Machine, words: str, number: str) -> None:
    """A line of JSON every second, and nothing else."""
    program = things.start("topic", *words.split(), "--json", cwd=Path("/"))
    program.wait_for("window")
    assert program.end(signal.SIGINT) == 0
    first = json.loads(program.text.splitlines()[0])
    assert first["topic"] == "/things"
    assert first[number] > 0
