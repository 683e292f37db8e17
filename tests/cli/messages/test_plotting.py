"""`topic plot` and `bag plot`."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from graphflow.bag.contents import Topic
from graphflow.cli.messages.plotting import PlotOptions, _finished, _show, curves_of, parse_fields
from graphflow.errors import UsageFault
from graphflow.introspect.drawing.curves import Curve
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_msgs.msg import Float64
from tests.bag.cast import record, write
from tests.cases import slow
from tests.conftest import Machine

TOPICS = {"/pose": ["turtlesim/msg/Pose"], "/a": [], "/a/b": []}


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (["/pose"], {"/pose": []}),
        (["pose.x,theta"], {"/pose": ["x", "theta"]}),
        (["/pose.x", "/pose.y"], {"/pose": ["x", "y"]}),
        (["/pose/x"], {"/pose": ["x"]}),
        (["/a/b/linear/x"], {"/a/b": ["linear.x"]}),
        (["/a/c"], {"/a": ["c"]}),
        (["/none/x"], {"/none/x": []}),
        (["/none.points[3].x"], {"/none": ["points[3].x"]}),
        (["/pose/ranges[0]"], {"/pose": ["ranges[0]"]}),
    ],
)
def test_words(words: list[str], meant: dict[str, list[str]]) -> None:
    """A field follows a dot, or a slash where a topic is above it."""
    assert parse_fields(words, TOPICS) == meant


def test_labels() -> None:
    """Labels include the topic if there are several."""
    types = {"/a": "geometry_msgs/msg/Twist", "/b": "std_msgs/msg/Bool", "/s": "std_msgs/msg/String"}
    assert [c.label for c in curves_of({"/a": ["linear.x"]}, types)["/a"]] == ["linear.x"]
    both = curves_of({"/a": ["linear.x"], "/b": []}, types)
    assert [c.label for some in both.values() for c in some] == ["/a.linear.x", "/b.data"]
    assert len(curves_of({"/a": []}, types)["/a"]) == 6
    with pytest.raises(UsageFault, match="/s: std_msgs/msg/String has no field that is a number"):
        curves_of({"/s": []}, types)


def test_files_need_what_draws_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Told before anything is done."""
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(UsageFault, match=r"the extra `plot`: pip install .*\[plot\]"):
        PlotOptions(png="a.png").check()
    PlotOptions().check()


@pytest.fixture
def speeds(tmp_path: Path) -> Path:
    """A bag in which a speed rises from 0 to 9 within 9 seconds."""
    topic = Topic("/speed", "geometry_msgs/msg/Twist")
    messages = [Twist(linear=Vector3(x=float(second))).to_bytes() for second in range(10)]
    records = [record(topic, data, float(second)) for second, data in enumerate(messages)]
    return write(tmp_path / "speeds", records)


@slow
def test_a_bag(machine: Machine, speeds: Path, tmp_path: Path) -> None:
    """In letters, as numbers, and as files."""
    text = machine.look("bag", "plot", str(speeds), "/speed.linear.x")
    assert "linear.x 9" in text
    assert "│" in text
    rows = machine.look("bag", "plot", str(speeds), "/speed/linear/x", "--csv", "--start", "8").splitlines()
    assert rows == ["seconds,name,value", "8.000000,linear.x,8.0", "9.000000,linear.x,9.0"]
    assert len(machine.look("bag", "plot", str(speeds), "/speed.linear.x", "--csv", "--end", "3").splitlines()) == 4
    png, svg = tmp_path / "a.png", tmp_path / "a.svg"
    text = machine.look("bag", "plot", str(speeds), "/speed.linear.x", "--png", str(png), "--svg", str(svg))
    assert text == f"{svg}\n{png}\n"
    assert png.read_bytes().startswith(b"\x89PNG")
    assert "<svg" in svg.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["/sped.linear.x"], 1, "has no topic /sped; did you mean '/speed'?"),
        (["/speed.liner.x"], 2, "has no field 'liner'; did you mean 'linear'?"),
        (["/speed.linear"], 2, "not a number; choose a field, as in linear.x"),
        (["/speed.linear.x", "--start", "50"], 1, "no message of /speed has arrived"),
        (["/speed.linear.x", "--png", "/nowhere/a.png"], 2, "/nowhere/a.png: there is no folder /nowhere"),
    ],
)
def test_mistakes(machine: Machine, speeds: Path, words: list[str], code: int, message: str) -> None:
    """Each error lists or suggests what exists."""
    assert message in machine.look("bag", "plot", str(speeds), *words, code=code)


NODE = """
from graphflow import Node, Publisher, timer
from graphflow.msgs.geometry_msgs.msg import Twist

class Drive(Node):
    speed = Publisher(Twist, "speed")

    @timer(hz=50)
    def tick(self):
        twist = Twist()
        twist.linear.x += 2.5
        self.speed.publish(twist)
"""


@pytest.fixture
def drive(machine: Machine, tmp_path: Path) -> Iterator[Machine]:
    """A machine on which something moves."""
    (tmp_path / "drive.py").write_text(NODE)
    (tmp_path / "g.yaml").write_text("nodes: {/drive: {class: drive:Drive}}\n")
    machine.run("up", "-d", "g.yaml", cwd=tmp_path)
    yield machine
    machine.run("down", cwd=tmp_path)


@slow
@pytest.mark.real
def test_a_topic(drive: Machine, tmp_path: Path) -> None:
    """A topic is plotted for some time or until Ctrl-C; for a missing one, the nearest is suggested."""
    text = drive.run("topic", "plot", "/speed.linear.x", "--duration", "0.5")
    assert "linear.x 2.5" in text
    assert "did you mean '/speed'?" in drive.run("topic", "plot", "/sped", code=1)
    program = drive.start("topic", "plot", "/speed/linear/x", "--svg", str(tmp_path / "s.svg"))
    program.wait_for("listening to /speed until Ctrl-C")
    drive.run("topic", "echo", "/speed", "--once")
    assert program.end(signal.SIGINT) == 0
    assert (tmp_path / "s.svg").is_file()


def test_messages_without_the_number(capsys: pytest.CaptureFixture[str]) -> None:
    """The error says that messages arrived, and what they lack; NaN and huge numbers do not count."""
    lacking = Curve("ranges[900]", "sensor_msgs/msg/LaserScan")
    lacking.add(0.0, LaserScan(ranges=[1.0, 2.0]))
    assert _finished({"/scan": [lacking]}, PlotOptions()) == 1
    assert "1 messages of /scan arrived, but none had ranges[900]" in capsys.readouterr().err
    huge = Curve("data", "std_msgs/msg/Float64")
    huge.add(0.0, Float64(data=1.7e308))
    assert _finished({"/x": [huge]}, PlotOptions()) == 1
    huge.add(1.0, Float64(data=-3.0))
    assert _finished({"/x": [huge]}, PlotOptions()) == 0
    assert "data -3" in capsys.readouterr().out


def test_a_terminal(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """The picture is drawn over the last one, in colours unless the user wants none; what is old is dropped."""
    curve = Curve("linear.x", "geometry_msgs/msg/Twist")
    for second in range(100):
        curve.add(float(second), Twist(linear=Vector3(x=float(second))))
    monkeypatch.delenv("NO_COLOR", raising=False)
    _show({"/speed": [curve]}, 99.0, 10.0)
    text = capsys.readouterr().out
    assert text.startswith("\x1b[H")
    assert text.endswith("\x1b[J")
    assert "linear.x 99" in text
    assert "\x1b[38;2;" in text
    assert len(curve.times) == 11
    monkeypatch.setenv("NO_COLOR", "1")
    _show({"/speed": [curve]}, 99.0, 10.0)
    assert "\x1b[38;2;" not in capsys.readouterr().out
    _show({"/speed": [curve]}, 999.0, 10.0)
    assert "no message of /speed has arrived" in capsys.readouterr().out
