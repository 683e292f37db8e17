"""The information on a bag, in ROS 2's terms."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import pytest

from graphflow.bag import info
from graphflow.bag.contents import Topic
from graphflow.bag.reader import Bag
from graphflow.msgs.std_msgs.msg import String
from tests.bag.cast import CHATTER, record, write

EVENTS = Topic("/add/_service_event", "example_interfaces/srv/AddTwoInts_Event")


@pytest.fixture
def utc(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(time, "localtime", time.gmtime)


@pytest.mark.usefixtures("utc")
def test_the_words(tmp_path: Path) -> None:
    """The lines of `ros2 bag info`, with services apart from topics."""
    folder = write(tmp_path / "bag")
    told = list(info.lines(Bag(folder)))
    assert told[1] == "Files:             bag_0.mcap"
    assert told[3:] == [
        "Storage id:        mcap",
        "ROS Distro:        jazzy",
        "Duration:          1.950000000s",
        "Start:             Nov 14 2023 22:13:20.000000000 (1700000000.000000000)",
        "End:               Nov 14 2023 22:13:21.950000000 (1700000001.950000000)",
        "Messages:          41",
        "Topic information: Topic: /chatter | Type: std_msgs/msg/String | Count: 20 | Serialization Format: cdr",
        "                   Topic: /count | Type: std_msgs/msg/Int32 | Count: 20 | Serialization Format: cdr",
        "                   Topic: /map | Type: std_msgs/msg/String | Count: 1 | Serialization Format: cdr",
        "Services:          0",
        "Service information:",
    ]


def test_services_and_more(tmp_path: Path) -> None:
    """Calls are counted for themselves; `-v` tells QoS, hash and definition."""
    folder = write(tmp_path / "bag", [record(CHATTER, String(data="a"), 0.0), record(EVENTS, b"\0\1\0\0", 1.0)])
    told = "\n".join(info.lines(Bag(folder), verbose=True))
    assert "Messages:          1\n" in told
    service = "Service: /add | Type: example_interfaces/srv/AddTwoInts | Event Count: 1 | Serialization Format: cdr"
    assert f"Services:          1\nService information: {service}\n" in told
    assert f"/chatter: std_msgs/msg/String {CHATTER.hash}\n  reliable volatile keep_last (10)\n  | string data" in told


@pytest.mark.parametrize(("sort", "first"), [("name", "/chatter"), ("type", "/count"), ("count", "/map")])
def test_the_order_of_topics(tmp_path: Path, sort: str, first: str) -> None:
    """By name, type or count."""
    [line] = [t for t in info.lines(Bag(write(tmp_path / "bag")), sort) if t.startswith("Topic information")]
    assert f"Topic: {first} " in line


def test_an_empty_bag(tmp_path: Path) -> None:
    """Has no time."""
    told = list(info.lines(Bag(write(tmp_path / "bag", []))))
    assert "Start:             none" in told
    assert "Topic information:" in told


@pytest.mark.parametrize(
    ("count", "text"),
    [(0, "0 B"), (1023, "1023 B"), (233_984, "228.5 KiB"), (5 << 20, "5.0 MiB"), (3 << 30, "3.0 GiB")],
)
def test_sizes(count: int, text: str) -> None:
    """In units of 1024, as rosbag2 has them."""
    assert info.size(count) == text


def test_for_programs(tmp_path: Path) -> None:
    """The same as data."""
    data: Any = info.as_json(Bag(write(tmp_path / "bag")))
    assert (data["messages"], data["whole"], data["storage"]) == (41, True, "mcap")
    assert data["topics"][0]["name"] == "/map"
