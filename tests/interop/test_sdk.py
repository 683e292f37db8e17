"""zenoh-ros2-sdk, an implementation of the same wire by others, talks with graphflow both ways."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import Machine, Program

pytest.importorskip("zenoh_ros2_sdk", reason="zenoh-ros2-sdk is not installed")
pytestmark = pytest.mark.real

NODES = """\
import sys

import numpy as np

import graphflow
from graphflow import CallError, Client, Node, Publisher, service, subscription, task, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.msgs.std_msgs.msg import Header, String

PIXELS = (np.arange(480 * 640 * 3) % 251).astype(np.uint8)


class HearString(Node):
    @subscription(String, "from_sdk")
    async def heard(self, m):
        print("HEARD", m.data, flush=True)


class HearTwist(Node):
    @subscription(Twist, "from_sdk")
    async def heard(self, m):
        print("HEARD", (m.linear.x, m.linear.z, m.angular.y), flush=True)


class HearImage(Node):
    @subscription(Image, "from_sdk")
    async def heard(self, m):
        print("HEARD", (m.header.frame_id, m.step, bool((m.data == PIXELS).all())), flush=True)


class SayString(Node):
    chatter = Publisher(String, "chatter")

    @timer(0.05)
    async def say(self):
        self.chatter.publish(String(data="hello grüße"))


class SayTwist(Node):
    twist = Publisher(Twist, "twist")

    @timer(0.05)
    async def say(self):
        self.twist.publish(Twist(linear=Vector3(x=1.5, z=0.25), angular=Vector3(y=0.5)))


class SayImage(Node):
    image = Publisher(Image, "image")

    @timer(0.05)
    async def say(self):
        header = Header(frame_id="camera", stamp=self.clock.now())
        self.image.publish(Image(header=header, height=480, width=640, encoding="rgb8", step=1920, data=PIXELS))


class Adder(Node):
    @service(AddTwoInts, "add_two_ints")
    async def add(self, request):
        return AddTwoInts.Response(sum=request.a + request.b)


class Caller(Node):
    adder = Client(AddTwoInts, "add_sdk")

    @task
    async def ask(self):
        await self.adder.wait_ready(15.0)
        for a in (2, 40, -1):
            try:
                print("HEARD", (await self.adder.call(AddTwoInts.Request(a=a, b=3))).sum, flush=True)
            except CallError as error:
                print("HEARD", type(error).__name__, flush=True)


graphflow.run(globals()[sys.argv.pop(1)])
"""


def node(machine: Machine, folder: Path, name: str) -> Program:
    (folder / "peers.py").write_text(NODES, encoding="utf-8")
    return machine.start_python("peers.py", name, cwd=folder)


def sdk(machine: Machine, folder: Path, role: str) -> Program:
    # Whatever it looks for, it is not to write to the user's git configuration or cache.
    machine.env |= {
        "ZENOH_ROS2_SDK_CACHE": str(folder / "cache"),
        "GIT_CONFIG_GLOBAL": str(folder / "gitconfig"),
        "GIT_TERMINAL_PROMPT": "0",
    }
    return machine.start_python(str(Path(__file__).with_name("sdk_peer.py")), role)


MESSAGES = {
    "String": "HEARD hello grüße",
    "Twist": "HEARD (1.5, 0.25, 0.5)",
    "Image": "HEARD ('camera', 1920, True)",
}


@pytest.mark.parametrize(("type_", "heard"), MESSAGES.items())
def test_it_hears_graphflow(machine: Machine, tmp_path: Path, type_: str, heard: str) -> None:
    """A text, numbers and an image of 0.9 MB arrive as they were sent."""
    node(machine, tmp_path, f"Say{type_}")
    sdk(machine, tmp_path, f"hear-{type_.lower()}").wait_for(heard)


@pytest.mark.parametrize(("type_", "heard"), MESSAGES.items())
def test_graphflow_hears_it(machine: Machine, tmp_path: Path, type_: str, heard: str) -> None:
    """The other way round."""
    listener = node(machine, tmp_path, f"Hear{type_}")
    machine.until(lambda: "/hear" in machine.run("node", "list", code=None), "the listener is up")
    sdk(machine, tmp_path, f"say-{type_.lower()}")
    listener.wait_for(heard)


def test_it_calls_graphflow(machine: Machine, tmp_path: Path) -> None:
    """AddTwoInts, twice."""
    node(machine, tmp_path, "Adder")
    client = sdk(machine, tmp_path, "call")
    assert client.wait() == 0
    assert "HEARD 5\nHEARD 43\n" in client.text


def test_graphflow_calls_it(machine: Machine, tmp_path: Path) -> None:
    """A client that waits gets the very first answer, though that server announces itself before it can be reached."""
    caller = node(machine, tmp_path, "Caller")
    machine.until(lambda: "/caller" in machine.run("node", "list", code=None), "the caller is up")
    sdk(machine, tmp_path, "serve")
    caller.wait_for("HEARD 5\nHEARD 43\nHEARD RemoteError")


def test_it_lists_what_graphflow_has(machine: Machine, tmp_path: Path) -> None:
    """Topics and services, hidden from nobody, with their types."""
    node(machine, tmp_path, "Adder")
    node(machine, tmp_path, "SayTwist")
    looker = sdk(machine, tmp_path, "look")
    for line in (
        "TOPIC /twist geometry_msgs/msg/Twist",
        "TOPIC /rosout rcl_interfaces/msg/Log",
        "SERVICE /add_two_ints example_interfaces/srv/AddTwoInts",
        "SERVICE /adder/get_parameters rcl_interfaces/srv/GetParameters",
    ):
        looker.wait_for(line)
