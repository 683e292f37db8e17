"""Whether memory stays flat: two nodes in processes of their own, messages and calls at 1 kHz, for ten minutes.

Printed is both processes' private memory (USS, MB) twenty times on the way. Goal: in the second half it grows by no
more than 0.5 MB; until then allocators settle.
"""

from __future__ import annotations

import re
import subprocess
import sys
import time

import psutil

from benchmarks.rounds import goal
from benchmarks.startup import GRAPHFLOW, own_machine

LIMIT = 30.0
NODES = """
from graphflow import Client, Node, Publisher, service, subscription, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.geometry_msgs.msg import Twist

class Busy(Node):
    cmd_vel = Publisher(Twist, "cmd_vel")
    add = Client(AddTwoInts, "add")
    n = 0

    @timer(hz=1000.0)
    async def say(self) -> None:
        self.cmd_vel.publish(Twist())

    @timer(hz=1000.0)
    async def ask(self) -> None:
        self.n += 1
        assert (await self.add.call(AddTwoInts.Request(a=self.n, b=1))).sum == self.n + 1

class Answers(Node):
    heard = 0

    @subscription(Twist, "cmd_vel")
    async def hear(self, message: Twist) -> None:
        self.heard += 1

    @service(AddTwoInts, "add")
    async def sum_up(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    @timer(10.0)
    async def tell(self) -> None:
        self.log.info("heard %d", self.heard)
"""


def main() -> None:
    seconds = 60.0 * float(sys.argv[1]) if len(sys.argv) > 1 else 600.0
    folder = own_machine()
    (folder / "nodes").mkdir()
    (folder / "nodes" / "soak.py").write_text(NODES)
    (folder / "pyproject.toml").touch()
    graph = "nodes:\n  /answers: {class: nodes.soak:Answers}\n  /busy: {class: nodes.soak:Busy, after: /answers}\n"
    (folder / "soak.yaml").write_text(graph)
    command = [*GRAPHFLOW, "up", "-d", str(folder / "soak.yaml")]
    subprocess.run(command, check=True, capture_output=True, timeout=LIMIT)
    try:
        listing = subprocess.run([*GRAPHFLOW, "ps", "--json"], check=True, capture_output=True, text=True)
        workers = [psutil.Process(int(pid)) for pid in re.findall(r'"pid": (\d+)', listing.stdout)]
        weights: list[list[float]] = []
        for _ in range(20):
            time.sleep(seconds / 20)
            weights.append([w.memory_full_info().uss / 1e6 for w in workers])
            print("  ".join(f"{weight:.2f}" for weight in weights[-1]), flush=True)
    finally:
        subprocess.run([*GRAPHFLOW, "down"], check=True, capture_output=True, timeout=LIMIT)
    heard = re.findall(r"heard (\d+)", (folder / "graphflow" / "soak" / "latest" / "answers.log").read_text())
    print(f"heard {heard[-1]} messages in {seconds:.0f} s")
    growth = max(last - half for half, last in zip(weights[9], weights[-1], strict=True))
    goal("growth in the second half, MB", growth, 0.5)


if __name__ == "__main__":
    main()
