"""zenoh-ros2-sdk, an implementation of the same wire by others, talks with graphflow both ways."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import PROGRAMS, Machine, Program

pytest.importorskip("zenoh_ros2_sdk", reason="zenoh-ros2-sdk is not installed")
pytestmark = pytest.mark.real

NODES = str(PROGRAMS / "interop" / "peers.py")


def node(machine: Machine, folder: Path, name: str) -> Program:
    return machine.start_python(NODES, name, cwd=folder)


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


@pytest.mark.parametrize(
    ("type_", "heard"),
    [pytest.param(*pair, marks=() if pair[0] == "Twist" else slow) for pair in MESSAGES.items()],
)
def test_it_hears_graphflow(machine: Machine, tmp_path: Path, type_: str, heard: str) -> None:
    """A text, numbers and an image of 0.9 MB arrive as they were sent."""
    node(machine, tmp_path, f"Say{type_}")
    sdk(machine, tmp_path, f"hear-{type_.lower()}").wait_for(heard)


@slow
@pytest.mark.parametrize(("type_", "heard"), MESSAGES.items())
def test_graphflow_hears_it(machine: Machine, tmp_path: Path, type_: str, heard: str) -> None:
    """The other way round."""
    listener = node(machine, tmp_path, f"Hear{type_}")
    machine.until(lambda: "/hear" in machine.run("node", "list", code=None), "the listener is up")
    sdk(machine, tmp_path, f"say-{type_.lower()}")
    listener.wait_for(heard)


@slow
def test_it_calls_graphflow(machine: Machine, tmp_path: Path) -> None:
    """AddTwoInts, twice."""
    node(machine, tmp_path, "Adder")
    client = sdk(machine, tmp_path, "call")
    assert client.wait() == 0
    assert "HEARD 5\nHEARD 43\n" in client.text


@slow
def test_graphflow_calls_it(machine: Machine, tmp_path: Path) -> None:
    """A client that waits gets the very first answer, though that server announces itself before it can be reached."""
    caller = node(machine, tmp_path, "Caller")
    machine.until(lambda: "/caller" in machine.run("node", "list", code=None), "the caller is up")
    sdk(machine, tmp_path, "serve")
    caller.wait_for("HEARD 5\nHEARD 43\nHEARD RemoteError")


@slow
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
