"""Commands of ROS 2's courses in a real shell, with `ros2` for `graphflow`, beside a running turtlesim."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import Machine, Program

pytestmark = [pytest.mark.real, slow]

SHELL = 'ros2() { python -m graphflow "$@"; }; cd "$PLACE"\n'
VECTOR3 = "geometry_msgs.msg.Vector3"
TWIST = f"geometry_msgs.msg.Twist(linear={VECTOR3}(x=2.0, y=0.0, z=0.0), angular={VECTOR3}"
POSE = r"x: \d+\.\d+\ny: \d+\.\d+\ntheta: -?\d+\.\d+\nlinear_velocity: -?\d+\.\d+\nangular_velocity: -?\d+\.\d+\n---\n"
VECTOR = "\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder in which a student works."""
    folder = tmp_path_factory.mktemp("student")
    (folder / "params.yaml").write_text("/turtlesim:\n  ros__parameters:\n    background_r: 10\n")
    return folder


@pytest.fixture(scope="module")
def turtlesim(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Machine]:
    """A machine on which turtlesim was started as the courses do."""
    machine = Machine(tmp_path_factory.mktemp("turtlesim"))
    program = machine.start("run", "turtlesim", "turtlesim_node")
    program.wait_for("Spawning turtle [turtle1]")
    yield machine
    assert program.end() == 0
    machine.close()


def typed(machine: Machine, place: Path, line: str) -> tuple[str, int]:
    """Run a line in bash; return its output, including errors, and its exit code."""
    path = f"{Path(sys.executable).parent}:{machine.env['PATH']}"
    env = machine.env | {"PLACE": str(place), "PATH": path}
    done = subprocess.run(
        ["bash", "--norc", "-c", SHELL + line],
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=60,
        check=False,
    )
    return done.stdout, done.returncode


# Each stands for itself: they may be typed in any order, beside different turtlesims.
SAID = [
    ("ros2 node list", "/turtlesim\n"),
    ("ros2 topic list", "/parameter_events\n/rosout\n/turtle1/cmd_vel\n/turtle1/color_sensor\n/turtle1/pose\n"),
    ("ros2 topic list -t | grep pose", "/turtle1/pose [turtlesim/msg/Pose]\n"),
    ("ros2 topic info /turtle1/pose", "Type: turtlesim/msg/Pose\nPublisher count: 1\nSubscription count: 0\n"),
    ("ros2 topic type /turtle1/pose", "turtlesim/msg/Pose\n"),
    ("ros2 interface show geometry_msgs/msg/Twist", f"Vector3  linear\n{VECTOR}Vector3  angular\n{VECTOR}"),
    ("ros2 interface show std_msgs/msg/String", "string data\n"),
    (
        "ros2 interface show turtlesim/msg/Pose",
        "float32 x\nfloat32 y\nfloat32 theta\nfloat32 linear_velocity\nfloat32 angular_velocity\n",
    ),
    ("ros2 interface show turtlesim/srv/SetPen", "uint8 r\nuint8 g\nuint8 b\nuint8 width\nuint8 off\n---\n"),
    ("ros2 interface show example_interfaces/srv/AddTwoInts", "int64 a\nint64 b\n---\nint64 sum\n"),
    ("ros2 interface package turtlesim_msgs | grep msg/", "turtlesim_msgs/msg/Color\nturtlesim_msgs/msg/Pose\n"),
    ("ros2 service type /turtle1/set_pen", "turtlesim/srv/SetPen\n"),
    ("ros2 service info /turtle1/set_pen", "Type: turtlesim/srv/SetPen\nClients count: 0\nServices count: 1\n"),
    (
        'ros2 service call /turtle1/set_pen turtlesim/srv/SetPen "{r: 255, g: 0, b: 0, width: 3, off: 0}"',
        "requester: making request: turtlesim.srv.SetPen_Request(r=255, g=0, b=0, width=3, off=0)\n\n"
        "response:\nturtlesim.srv.SetPen_Response()\n\n",
    ),
    ("ros2 param get /turtlesim background_g", "Integer value is: 86\n"),
    (
        "ros2 param set /turtlesim background_r 150; ros2 param get /turtlesim background_r",
        "Set parameter successful\nInteger value is: 150\n",
    ),
    ("ros2 param dump /turtlesim | grep -A2 turtlesim", "/turtlesim:\n  ros__parameters:\n    background_b: 255\n"),
    (
        "ros2 param load /turtlesim params.yaml; ros2 param get /turtlesim background_r",
        "Set parameter background_r successful\nInteger value is: 10\n",
    ),
    ("ros2 action list", "/turtle1/rotate_absolute\n"),
    ("ros2 action list -t", "/turtle1/rotate_absolute [turtlesim/action/RotateAbsolute]\n"),
    (
        "ros2 action info /turtle1/rotate_absolute",
        "Action: /turtle1/rotate_absolute\nAction clients: 0\nAction servers: 1\n    /turtlesim\n",
    ),
    (
        "ros2 service call /spawn turtlesim/srv/Spawn \"{x: 2.0, y: 2.0, theta: 0.0, name: 'turtle2'}\"; "
        "ros2 service call /kill turtlesim/srv/Kill \"{name: 'turtle2'}\"",
        "requester: making request: turtlesim.srv.Spawn_Request(x=2.0, y=2.0, theta=0.0, name='turtle2')\n\n"
        "response:\nturtlesim.srv.Spawn_Response(name='turtle2')\n\n"
        "requester: making request: turtlesim.srv.Kill_Request(name='turtle2')\n\n"
        "response:\nturtlesim.srv.Kill_Response()\n\n",
    ),
    (
        "ros2 pkg executables turtlesim",
        "".join(f"turtlesim {name}\n" for name in ("draw_square", "mimic", "turtle_teleop_key", "turtlesim_node")),
    ),
]


@pytest.mark.parametrize(("line", "said"), SAID, ids=[f"{n:02} {line[5:40]}" for n, (line, _) in enumerate(SAID)])
def test_what_is_said(turtlesim: Machine, place: Path, line: str, said: str) -> None:
    """The output is exactly that of ROS 2."""
    assert typed(turtlesim, place, line) == (said, 0)


LIKE = [
    ("ros2 node info /turtlesim", r"/turtlesim\n  Subscribers:\n    /turtle1/cmd_vel: geometry_msgs/msg/Twist\n"),
    (
        "ros2 node info /turtlesim --verbose",
        r"/pose: turtlesim/msg/Pose  \(RELIABLE, VOLATILE, KEEP_LAST \(7\)",
    ),
    ("ros2 topic info /turtle1/pose --verbose", r"Endpoint type: PUBLISHER\nGID: (\w\w\.)+\w\w\nQoS profile:\n"),
    ("ros2 topic echo /turtle1/pose --once", POSE),
    ("ros2 topic echo /turtle1/pose turtlesim/msg/Pose --once", POSE),
    (
        "ros2 topic echo /turtle1/cmd_vel --flow-style --timeout 0.2 --once",
        r"no message on /turtle1/cmd_vel within 0.2 s",
    ),
    (
        "timeout -s INT 20 python -m graphflow topic hz /turtle1/pose | head -2",
        r"average rate: \d+\.\d{3}\n\tmin: 0\.\d",
    ),
    ("ros2 interface list --only-msgs", r"^Messages:\n    \w+/msg/"),
    ("ros2 interface package std_msgs", r"std_msgs/msg/String\n"),
    ("ros2 interface package", r"std_msgs\nstd_srvs\n"),
    ("ros2 interface info std_msgs/Header", r"string frame_id\n"),
    (
        "timeout -s INT 20 python -m graphflow topic pub -r 10 /turtle1/cmd_vel geometry_msgs/msg/Twist "
        "'{linear: {x: 2.0, y: 0.0, z: 0.0}, angular: {x: 0.0, y: 0.0, z: 1.8}}' | head -2",
        r"publisher: beginning loop\npublishing #1: " + re.escape(TWIST + "(x=0.0, y=0.0, z=1.8))"),
    ),
    (
        "ros2 topic pub /turtle1/cmd_vel geometry_msgs/msg/Twist '{linear: {x: 2.0}}' -1",
        r"publishing #1: " + re.escape(TWIST),
    ),
    ("ros2 service list", r"/clear\n/kill\n/reset\n/spawn\n/turtle1/set_pen\n"),
    ("ros2 param list", r"/turtlesim:\n  background_b\n  background_g\n  background_r\n"),
    (
        "ros2 action send_goal /turtle1/rotate_absolute turtlesim/action/RotateAbsolute {theta: 1.57} -f",
        r"Goal accepted with ID: [0-9a-f]{32}\n(.*\n)*Feedback:\n    remaining: .*\n(.*\n)*"
        r"Goal finished with status: SUCCEEDED\n",
    ),
    (
        "timeout 60 python -m graphflow run demo_nodes_cpp add_two_ints_server & "
        'ros2 service call /add_two_ints example_interfaces/srv/AddTwoInts "{a: 2, b: 5}"; kill %1; wait',
        r"AddTwoInts_Response\(sum=7\)",
    ),
    (
        "timeout -s INT 4 python -m graphflow bag record /turtle1/pose -o my_bag; ros2 bag info my_bag; "
        "ros2 bag play my_bag --playback-duration 0.5",
        r"Topic: /turtle1/pose \| Type: turtlesim/msg/Pose \| Count: \d+ \| Serialization Format: cdr(.*\n)*"
        r"played \d+ messages in",
    ),
    (
        "ros2 pkg create --build-type ament_python robots_are_awesome",
        r"going to create a new package\npackage ",
    ),
    ("ros2 pkg create my_robot_controller --dependencies rclpy", r"creating folder \./my_robot_controller\ncreating "),
    ("ros2 pkg prefix turtlesim", r"^/"),
    ("ros2 --version", r"graphflow, version \d"),
    ("ros2 run rqt_graph rqt_graph", r"/turtlesim"),
    ("ros2 wtf", r"1 node, no fault; the lines above may be intended"),
]


@pytest.mark.parametrize(("line", "like"), LIKE, ids=[f"{n:02} {line[5:40]}" for n, (line, _) in enumerate(LIKE)])
def test_what_is_said_with_numbers(turtlesim: Machine, place: Path, line: str, like: str) -> None:
    """The output is that of ROS 2, except for numbers."""
    text, code = typed(turtlesim, place, line)
    assert re.search(like, text), text
    assert "Traceback" not in text
    assert code in (0, 4, 124), text


# The mistakes of the slides.
MISTAKES = [
    ("ros2 run demo_nodes_cpp talker ___ns:=/turtle1", r"'___ns' is not a remap key; did you mean '__ns:=/turtle1'\?"),
    (
        "ros2 run demo_nodes_cpp talker --ros-args -r ___ns:=/t",
        r"'___ns' is not a remap key; did you mean '__ns:=/t'\?",
    ),
    (
        "ros2 run nodes.via_point_follower:ViaPointFollower --ros-args -r /turtle2/goal:=/turtle1/pose",
        r"the remap /turtle2/goal:=/turtle1/pose matches no name of this node; there is cmd_vel, pose",
    ),
    ("ros2 interface show sensor_msgs/JoinState", r"did you mean 'JointState'\?"),
    ("ros2 pkg create my-package", r"did you mean 'my_package'\?"),
    ("ros2 node info /turtlesin", r"there is no node /turtlesin; did you mean '/turtlesim'\?"),
    ("ros2 topic echo /turtle1/psoe", r"does not appear to be published yet; did you mean '/turtle1/pose'\?"),
]


@pytest.mark.parametrize(("line", "told"), MISTAKES, ids=[line[5:45] for line, _ in MISTAKES])
def test_mistakes_of_the_slides(turtlesim: Machine, place: Path, line: str, told: str) -> None:
    """Mistakes copied from slides are corrected."""
    text, code = typed(turtlesim, place, line)
    assert re.search(told, text), text
    assert code in (1, 2)


TAKEN = [
    "run turtlesim turtlesim_node --ros-args -r __node:=sim2 -r __ns:=/two",
    "run turtlesim turtlesim_node --ros-args -r __ns:=/three --log-level warn",
    "run demo_nodes_py talker chatter:=news",
    "run demo_nodes_cpp talker.py --ros-args -p rate:=10.0",
]


@pytest.mark.parametrize("words", TAKEN)
def test_words_of_the_slides_that_are_taken(turtlesim: Machine, words: str) -> None:
    """Nodes start, and end cleanly by Ctrl-C."""
    program: Program = turtlesim.start(*words.split())
    turtlesim.until(lambda: len(turtlesim.look("node", "list").split()) == 2, "the node is there")
    assert program.end() == 0, program.text


PUBLISHER = """
from graphflow import Node, Publisher, timer
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_msgs.msg import String

class Source(Node):
    message = Publisher(String, "message")
    command = Publisher(Twist, "turtle1/cmd_vel")

    @timer(hz=10)
    def say(self) -> None:
        self.message.publish(String(data="hello"))
        self.command.publish(Twist())
"""
SUBSCRIBER = """
from graphflow import Node, subscription
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.turtlesim.msg import Pose

class Sink(Node):
    @subscription(String, "message")
    def hear(self, message: String) -> None:
        self.log.info("heard %s", message.data)

    @subscription(Pose, "turtle1/pose")
    def see(self, pose: Pose) -> None:
        self.log.info("x is %.1f", pose.x, throttle=0.5)
"""


@pytest.mark.parametrize("ending", ["", ".py"])
def test_a_package_of_ones_own(turtlesim: Machine, tmp_path: Path, ending: str) -> None:
    """Runs by the names of package and file, with and without the file's ending."""
    root = tmp_path / "aro_reactive_control"
    (root / "nodes").mkdir(parents=True)
    (root / "pyproject.toml").write_text('[project]\nname = "aro_reactive_control"\n')
    (root / "nodes" / "publisher.py").write_text(PUBLISHER)
    (root / "nodes" / "subscriber.py").write_text(SUBSCRIBER)
    source = turtlesim.start("run", "aro_reactive_control", f"publisher{ending}", cwd=root)
    sink = turtlesim.start("run", "aro_reactive_control", f"subscriber{ending}", cwd=root)
    sink.wait_for("heard hello")
    sink.wait_for("x is ")
    assert source.end() == 0
    assert sink.end() == 0
