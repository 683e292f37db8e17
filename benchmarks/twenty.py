"""Twenty node processes: how long until every one has heard its neighbour, what each weighs, what they cost idle.

In a graph of twenty nodes each publishes 200 times a second until it has heard the one before it. Then the same number
of nodes with a timer of 1 Hz that logs: proportional memory (PSS, MB a node process) and processor time (percent of one
core, all together).

Goals: 700 ms from the command to the last first message, 14 MB, 2 %.
"""

from __future__ import annotations

import re
import statistics
import subprocess
import sys
import time
from pathlib import Path

import psutil

from benchmarks.rounds import goal
from benchmarks.startup import GRAPHFLOW, own_machine

NODES = 20
IDLE_SECONDS = 20.0
LIMIT = 30.0
RING = """
from graphflow import Node, Publisher, subscription, timer
from graphflow.msgs.std_msgs.msg import String

class Ring(Node):
    mine = Publisher(String, "mine")
    heard = False

    @timer(0.005)
    async def say(self) -> None:
        self.mine.publish(String(data="hello"))

    @subscription(String, "before")
    async def hear(self, message: String) -> None:
        if not self.heard:
            self.heard = True
            self.log.info("heard")

class Idle(Node):
    @timer(1.0)
    async def tick(self) -> None:
        self.log.info("tick")
"""


def project(folder: Path) -> None:
    (folder / "nodes").mkdir()
    (folder / "nodes" / "ring.py").write_text(RING)
    (folder / "pyproject.toml").touch()
    ring = [
        f"  /n{i}: {{class: nodes.ring:Ring, remap: {{mine: /t{i}, before: /t{(i - 1) % NODES}}}}}"
        for i in range(NODES)
    ]
    (folder / "ring.yaml").write_text("nodes:\n" + "\n".join(ring) + "\n")
    idle = [f"  /n{i}: {{class: nodes.ring:Idle}}" for i in range(NODES)]
    (folder / "idle.yaml").write_text("nodes:\n" + "\n".join(idle) + "\n")


def down() -> None:
    subprocess.run([*GRAPHFLOW, "down"], check=True, capture_output=True, timeout=LIMIT)


def all_heard(folder: Path) -> float:
    """Milliseconds from the command to the last node's first message, by the times in the log lines."""
    began = time.time()
    subprocess.run([*GRAPHFLOW, "up", "-d", str(folder / "ring.yaml")], check=True, capture_output=True, timeout=LIMIT)
    logs = folder / "graphflow" / "ring" / "latest"
    try:
        while True:
            texts = [file.read_text() for file in logs.glob("n*.log")]
            times = [re.findall(r"\[INFO\] \[(\d+\.\d+)\] \[n\d+\]: heard", text) for text in texts]
            if len(times) == NODES and all(times):
                break
            assert time.time() - began < LIMIT, "not every node has heard something"
            time.sleep(0.05)
    finally:
        down()
    return (max(float(t[0]) for t in times) - began) * 1000


def idle(folder: Path) -> tuple[float, float]:
    """PSS in MB a node, and the percentage of a core that all use."""
    subprocess.run([*GRAPHFLOW, "up", "-d", str(folder / "idle.yaml")], check=True, capture_output=True, timeout=LIMIT)
    listing = subprocess.run([*GRAPHFLOW, "ps", "--json"], check=True, capture_output=True, text=True, timeout=LIMIT)
    workers = [psutil.Process(int(pid)) for pid in re.findall(r'"pid": (\d+)', listing.stdout)]
    assert len(workers) == NODES
    time.sleep(3.0)

    def used() -> float:
        return sum(t.user + t.system for t in (w.cpu_times() for w in workers))

    before, began = used(), time.monotonic()
    time.sleep(IDLE_SECONDS)
    share = (used() - before) / (time.monotonic() - began) * 100
    weight = statistics.mean(w.memory_full_info().pss for w in workers) / 1e6
    down()
    return weight, share


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    folder = own_machine()
    project(folder)
    times = [all_heard(folder) for _ in range(rounds)]
    print(f"{NODES} nodes, command to the last first message: " + ", ".join(f"{t:.0f}" for t in sorted(times)) + " ms")
    goal("median, ms", statistics.median(times), 700)
    weight, share = idle(folder)
    goal("PSS a node, MB", weight, 14)
    goal(f"{NODES} idle nodes together, % of a core", share, 2)


if __name__ == "__main__":
    main()
