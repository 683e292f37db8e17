"""Bags: written and read, beside `mcap` itself and `rosbags`; and a recording of 50 topics at 20 MB/s, nothing lost.

The goal is that a recorder loses nothing: `python -m benchmarks.bags SECONDS` records a graph of five nodes for so long
(10 s unless given) and compares what they sent with what is in the bag.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.rosbag2 import Reader as RosbagsReader
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as RosbagsWriter
from rosbags.typesys import Stores, get_typestore

from benchmarks.rounds import compare, goal
from graphflow.bag.contents import Record, Topic
from graphflow.bag.formats.definitions import known
from graphflow.bag.reader import Bag
from graphflow.bag.writer import BagWriter
from graphflow.msgs import registry
from graphflow.qos import DEFAULT

TYPE = "std_msgs/msg/UInt8MultiArray"
TOPIC = Topic("/data", TYPE, registry.hash_of(TYPE), known(TYPE), (DEFAULT,))
SIZES = ((20_000, 1000), (400, 100_000))
"""Messages, and bytes of each."""

PAYLOAD = 20_016
"""Bytes of CDR of a message of the nodes below."""
NODE = """
import numpy as np
from graphflow import Node, timer
from graphflow.msgs.std_msgs.msg import UInt8MultiArray
from graphflow.qos import Qos


class Load(Node):
    \"\"\"Publishes 20,000 bytes on each of ten topics 20 times a second.\"\"\"

    def __init__(self):
        super().__init__("load")
        first = int(self.name[-1]) * 10
        self.out = [self.create_publisher(UInt8MultiArray, f"/load/t{first + i}", Qos(depth=100)) for i in range(10)]
        self.data = np.random.default_rng(1).integers(0, 255, 20_000, dtype=np.uint8)

    @timer(hz=20)
    def tick(self):
        for publisher in self.out:
            publisher.publish(UInt8MultiArray(data=self.data))
"""


def records(count: int, size: int) -> list[Record]:
    payload = os.urandom(size)
    start = time.time_ns()
    return [Record(TOPIC, start + n * 1000, start + n * 1000, n, payload) for n in range(count)]


def with_graphflow(folder: Path, said: list[Record]) -> None:
    with BagWriter(folder, compression="none") as writer:
        for record in said:
            writer.add(record)


def with_mcap(folder: Path, said: list[Record], compression: str = "none") -> None:
    from mcap.writer import CompressionType

    folder.mkdir()
    with (folder / "a.mcap").open("wb") as stream:
        writer: Any = Writer(stream, compression=CompressionType[compression.upper()])
        writer.start("ros2")
        schema = writer.register_schema(TYPE, "ros2msg", TOPIC.definition.encode())
        channel = writer.register_channel("/data", "cdr", schema)
        for r in said:
            writer.add_message(channel, r.log_ns, r.data, r.publish_ns, r.sequence)
        writer.finish()


def with_rosbags(folder: Path, said: list[Record]) -> None:
    with RosbagsWriter(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/data", TYPE, typestore=get_typestore(Stores.ROS2_JAZZY))
        for r in said:
            writer.write(connection, r.log_ns, r.data)


def count(messages: Iterator[Any]) -> int:
    return sum(1 for _ in messages)


def read_by_graphflow(folder: Path) -> int:
    return count(Bag(folder).records())


def read_by_mcap(folder: Path) -> int:
    with next(folder.glob("*.mcap")).open("rb") as stream:
        return count(make_reader(stream).iter_messages())


def read_by_rosbags(folder: Path) -> int:
    with RosbagsReader(folder) as reader:
        return count(reader.messages())


WRITERS = {"mcap": with_mcap, "rosbags": with_rosbags, "graphflow": with_graphflow}
READERS = {"mcap": read_by_mcap, "rosbags": read_by_rosbags, "graphflow": read_by_graphflow}


def files(folder: Path, number: int, size: int) -> None:
    """Write and read messages of a size, each contender in turn; MB/s of messages."""
    said, megabytes = records(number, size), number * size / 1e6

    def write(way: str) -> float:
        shutil.rmtree(folder, ignore_errors=True)
        began = time.perf_counter()
        WRITERS[way](folder, said)
        return megabytes / (time.perf_counter() - began)

    def read(way: str) -> float:
        began = time.perf_counter()
        assert READERS[way](folder) == number
        return megabytes / (time.perf_counter() - began)

    print(f"\nwriting {number:,} messages of {size:,} bytes")
    compare({way: partial(write, way) for way in WRITERS}, rounds=7, unit="MB/s", baseline="mcap")
    write("graphflow")
    print("reading them")
    compare({way: partial(read, way) for way in READERS}, rounds=7, unit="MB/s", baseline="mcap")


def recording(root: Path, length: float) -> None:
    (root / "nodes").mkdir()
    (root / "pyproject.toml").touch()
    (root / "nodes" / "load.py").write_text(NODE)
    nodes = "".join(f"  /load{n}: {{class: nodes.load:Load}}\n" for n in range(5))
    (root / "load.yaml").write_text(f"nodes:\n{nodes}")
    gf = [sys.executable, "-m", "graphflow"]
    subprocess.run([*gf, "up", "-d", "load.yaml"], cwd=root, check=True, capture_output=True)
    try:
        words = ["bag", "record", "-e", "/load/", "-o", "bag", "--compression", "none", "--duration", str(length)]
        told = subprocess.run([*gf, *words], cwd=root, check=True, capture_output=True, text=True).stderr
    finally:
        subprocess.run([*gf, "down", "--graph", "load"], cwd=root, check=False, capture_output=True)
    print(f"\n{re.sub(r'(?m)^.*(Listening|Subscribed|Recording into).*$', '', told).strip()}")
    bag = Bag(root / "bag")
    last: dict[str, int] = {}
    missing = 0
    for record in bag.records():
        name = record.topic.name
        missing += record.sequence - last.get(name, record.sequence - 1) - 1
        last[name] = record.sequence
    span_ns = max(1, bag.contents.end_ns - bag.contents.start_ns)
    rate = bag.contents.message_count * PAYLOAD / span_ns * 1e3
    print(f"{len(bag.contents.topics)} topics, {bag.contents.message_count:,} messages, {rate:.1f} MB/s")
    goal("messages lost", missing, 0)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        for number, size in SIZES:
            files(Path(folder) / "bag", number, size)
        shutil.rmtree(Path(folder) / "bag")
        recording(Path(folder), float(sys.argv[1]) if len(sys.argv) > 1 else 10.0)


if __name__ == "__main__":
    main()
