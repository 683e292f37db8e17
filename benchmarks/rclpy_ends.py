"""Nodes written for rclpy, ended by Ctrl-C at random moments: each must end by itself, at once and without a word.

Half of them shut down, as tutorials have it, and half just end. Several run at once, so that ends are slow.

    python -m benchmarks.rclpy_ends 100

Goal: 100 of 100 clean ends.
"""

from __future__ import annotations

import random
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from benchmarks.peers import rendezvous
from benchmarks.rounds import goal

PROGRAM = """\
import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionClient, ActionServer
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
node, other = Node("ender"), Node("asker")
server = ActionServer(node, Fibonacci, "count", lambda goal: Fibonacci.Result())
client = ActionClient(other, Fibonacci, "count")
publisher = node.create_publisher(String, "ended", 10)
node.create_subscription(String, "ended", lambda message: None, 10)
node.create_timer(0.002, lambda: publisher.publish(String(data="x")))
print("up", flush=True)
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    pass
"""
SHUTDOWN = """\
node.destroy_node()
rclpy.try_shutdown()
"""
AT_ONCE = 4
"""Nodes that run at the same time."""
LONGEST = 0.3
"""Seconds within which the moment is chosen."""
LIMIT = 15.0
"""Seconds after which an end counts as none."""


def end(file: Path) -> tuple[bool, float, str]:
    """Start a node and end it: whether it was clean, seconds, and what was printed."""
    command = [sys.executable, "-m", "graphflow.rclpy", str(file)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(random.uniform(0, LONGEST))
        began = time.monotonic()
        process.send_signal(signal.SIGINT)
        try:
            said, _ = process.communicate(timeout=LIMIT)
        except subprocess.TimeoutExpired:
            process.kill()
            said = f"it did not end within {LIMIT:g} s"
    return process.returncode == 0 and not said, time.monotonic() - began, said


def main(count: int) -> None:
    """End so many, and print what came of them."""
    keep = rendezvous()
    with tempfile.TemporaryDirectory() as folder:
        tidy, careless = Path(folder, "tidy.py"), Path(folder, "careless.py")
        tidy.write_text(PROGRAM + SHUTDOWN)
        careless.write_text(PROGRAM)
        with ThreadPoolExecutor(AT_ONCE) as runner:
            ends = list(runner.map(end, [(tidy, careless)[turn % 2] for turn in range(count)]))
    clean = [seconds for is_clean, seconds, _ in ends if is_clean]
    for _, _, said in [e for e in ends if not e[0]][:3]:
        print(f"not clean: {said[-300:]}")
    took = f"; median {statistics.median(clean):.2f} s, longest {max(clean):.2f} s" if clean else ""
    print(f"{len(clean)} of {count} ended cleanly{took}")
    goal("clean ends", len(clean), count, at_least=True)
    del keep


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
