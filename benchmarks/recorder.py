"""CPU time of `bag record` at 30 MB/s, beside that of mcap's own writer with the same messages.

A process publishes 1,500 messages of 20,000 bytes a second on ten topics. In turn, `graphflow bag record` records them,
a node listens to them and drops them, and mcap's writer writes as many without a network.

    python -m benchmarks.recorder [ROUNDS]
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np
import psutil

from benchmarks.bags import TOPIC, with_mcap
from benchmarks.rounds import compare, goal
from graphflow.bag.contents import Record

TOPICS, HZ, SIZE = 10, 150, 20_000
LENGTH = 4.0
"""Seconds that are measured."""
SETTLED = 1.5
"""Seconds before that, in which the recorder starts."""
NODES = """
from itertools import cycle

import numpy as np

from graphflow import Node, timer
from graphflow.msgs.std_msgs.msg import UInt8MultiArray
from graphflow.qos import Qos
from graphflow.runtime.endpoints import raw


class Load(Node):
    def __init__(self):
        super().__init__("load")
        self.out = [self.create_publisher(UInt8MultiArray, f"/load/t{{n}}", Qos(depth=100)) for n in range({topics})]
        data = np.frombuffer(open("{data}", "rb").read(), np.uint8).reshape(-1, {size})
        self.said = cycle([UInt8MultiArray(data=row) for row in data])

    @timer(hz={hz})
    def tick(self):
        for publisher in self.out:
            publisher.publish(next(self.said))


class Ear(Node):
    def __init__(self):
        super().__init__("ear")

    async def on_start(self):
        for n in range({topics}):
            drop = lambda payload, info: None
            raw.subscribe(self, "std_msgs/msg/UInt8MultiArray", f"/load/t{{n}}", drop, Qos(depth=1000))
"""
GF = [sys.executable, "-m", "graphflow"]


def payloads() -> list[bytes]:
    """Bytes that become half as many when they are compressed, as those of cameras and lidars may."""
    data = np.random.default_rng(1).integers(0, 16, (500, SIZE), dtype=np.uint8)
    return [row.tobytes() for row in data]


def cost(words: list[str], folder: Path) -> float:
    """CPU seconds that a process takes for each second."""
    process = subprocess.Popen([*GF, *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        time.sleep(SETTLED)
        seen = psutil.Process(process.pid)
        before, began = seen.cpu_times(), time.perf_counter()
        time.sleep(LENGTH)
        after, passed = seen.cpu_times(), time.perf_counter() - began
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(10)
    return 100 * (after.user + after.system - before.user - before.system) / passed


def of_mcap(root: Path, compression: str) -> float:
    """The same for mcap's writer."""
    data, now = payloads(), time.time_ns()
    count = round(TOPICS * HZ * LENGTH)
    said = [Record(TOPIC, now + n, now + n, n, data[n % len(data)]) for n in range(count)]
    before = time.process_time()
    with_mcap(fresh(root), said, compression)
    return 100 * (time.process_time() - before) / LENGTH


def recorded(root: Path, compression: str) -> float:
    """The same for the recorder."""
    return cost(["bag", "record", "-e", "/load/", "--compression", compression, "-o", str(fresh(root))], root)


def fresh(root: Path) -> Path:
    """A name for a bag; the one before is removed."""
    shutil.rmtree(root / "bag", ignore_errors=True)
    return root / "bag"


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        (root / "data").write_bytes(b"".join(payloads()))
        (root / "load.py").write_text(NODES.format(topics=TOPICS, hz=HZ, size=SIZE, data=root / "data"))
        load = subprocess.Popen([*GF, "run", "load:Load"], cwd=root, stdout=subprocess.DEVNULL)
        try:
            for compression in ("none", "zstd"):
                print(f"\n30 MB/s, compression {compression}")
                contenders = {
                    "mcap": partial(of_mcap, root, compression),
                    "a node that listens": partial(cost, ["run", "load:Ear"], root),
                    "bag record": partial(recorded, root, compression),
                }
                found = compare(contenders, rounds, "% CPU", "mcap")
                beyond = found["bag record"][0] - found["a node that listens"][0]
                goal("recording beyond listening, over mcap", beyond / found["mcap"][0], 1.0)
        finally:
            load.send_signal(signal.SIGINT)
            load.wait(10)


if __name__ == "__main__":
    os.environ.setdefault("GRAPHFLOW_DOMAIN", "77")
    main()
