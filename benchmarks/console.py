"""What the console costs under load: processor time, draws, memory.

One node publishes at 1 kHz, five write 5,000 log lines a second together; the console shows nodes, logs and an echo of
the topic in a terminal of 120 x 40. Beside it, in turn, two processes that do the least that showing this takes: one
reads the log files, one hears the topic over raw Zenoh. Then the memory, before and after.

    python -m benchmarks.console                    # ten seconds of load, three rounds
    python -m benchmarks.console --seconds 3600     # an hour; the memory is what is of interest

Goals: a third of a core, 20 draws a second; after an hour no more than 50 MB above the first minute.
"""

from __future__ import annotations

import argparse
import fcntl
import json
import os
import pty
import select
import statistics
import struct
import subprocess
import sys
import termios
import threading
import time
from pathlib import Path

import psutil

from benchmarks.rounds import goal
from benchmarks.startup import GRAPHFLOW, own_machine

WRITERS, LINES = 5, 1000
LIMIT = 30.0
ROUNDS = 3
DRAW = b"\x1b[?2026h"
"""What a draw begins with in a terminal that synchronizes output, as ours says it does."""
NODES = """
from graphflow import Node, Publisher, timer
from graphflow.msgs.std_msgs.msg import Int64

class Writer(Node):
    count = 0

    @timer(0.01)
    async def write(self) -> None:
        for _ in range(LINES // 100):
            self.count += 1
            self.log.info("line %d of a log that says nothing of interest", self.count)

class Fast(Node):
    number = Publisher(Int64, "number")
    count = 0

    @timer(0.005)
    async def talk(self) -> None:
        for _ in range(5):
            self.count += 1
            self.number.publish(Int64(data=self.count))
""".replace("LINES", str(LINES))
READER = """
import sys, time
files = [open(name, "rb") for name in sys.argv[1:]]
for file in files:
    file.seek(0, 2)
while True:
    lines = sum(file.read().count(b"\\n") for file in files)
    time.sleep(0.1)
"""
LISTENER = """
import json, sys, time, zenoh
c = {"mode": "client", "connect": {"endpoints": [sys.argv[1]]}}
s = zenoh.open(zenoh.Config.from_json5(json.dumps(c)))
sub = s.declare_subscriber(sys.argv[2], lambda m: m.payload.to_bytes())
time.sleep(1e6)
"""


class Screen:
    """The console in a terminal that takes all it draws, and counts the draws."""

    def __init__(self) -> None:
        self.draws = 0
        pid, self._fd = pty.fork()
        if not pid:
            os.environ.update(TERM="xterm-256color", COLORTERM="truecolor")
            os.execv(sys.executable, [*GRAPHFLOW, "attach"])
        fcntl.ioctl(self._fd, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
        self.process = psutil.Process(pid)
        threading.Thread(target=self._take, daemon=True).start()

    def _take(self) -> None:
        while True:
            try:
                select.select([self._fd], [], [])
                data = os.read(self._fd, 1 << 16)
            except OSError:
                return
            self.draws += data.count(DRAW)
            if b"\x1b[?2026$p" in data:
                self.type("\x1b[?2026;2$y")

    def type(self, text: str) -> None:
        os.write(self._fd, text.encode())

    def close(self) -> None:
        self.process.terminate()
        os.waitpid(self.process.pid, 0)
        os.close(self._fd)


def project(folder: Path) -> Path:
    (folder / "nodes").mkdir()
    (folder / "nodes" / "load.py").write_text(NODES)
    (folder / "pyproject.toml").touch()
    writers = "\n".join(f"  /writer{i}: {{class: nodes.load:Writer}}" for i in range(WRITERS))
    windows = "console: {windows: [{panes: {rows: [nodes, log, {echo: /number}]}}]}"
    file = folder / "load.yaml"
    file.write_text(f"nodes:\n  /fast: {{class: nodes.load:Fast}}\n{writers}\n{windows}\n")
    return file


def cost(process: psutil.Process, seconds: float) -> float:
    """Per cent of one core that a process takes over some time."""
    before = process.cpu_times()
    time.sleep(seconds)
    after = process.cpu_times()
    return 100 * (after.user + after.system - before.user - before.system) / seconds


def least(folder: Path, domain: str, seconds: float) -> float:
    """Per cent of one core that a reader of the logs and a listener over raw Zenoh take together."""
    logs = sorted(str(f) for f in (folder / "graphflow" / "load" / "latest").glob("writer*.log"))
    raw = [sys.executable, "-c", LISTENER, os.environ["GRAPHFLOW_RENDEZVOUS"], f"{domain}/number/**"]
    processes = [subprocess.Popen([sys.executable, "-c", READER, *logs]), subprocess.Popen(raw)]
    time.sleep(1.0)
    before = [psutil.Process(p.pid).cpu_times() for p in processes]
    time.sleep(seconds)
    after = [psutil.Process(p.pid).cpu_times() for p in processes]
    for process in processes:
        process.terminate()
        process.wait(LIMIT)
    return sum(100 * (a.user + a.system - b.user - b.system) / seconds for b, a in zip(before, after, strict=True))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=10.0, help="of a round")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    options = parser.parse_args()
    folder = own_machine()
    up = [*GRAPHFLOW, "up", "-d", str(project(folder))]
    subprocess.run(up, check=True, capture_output=True, timeout=LIMIT)
    [run] = json.loads(subprocess.run([*GRAPHFLOW, "ls", "--json"], capture_output=True, timeout=LIMIT).stdout)
    screen = Screen()
    try:
        time.sleep(min(60.0, 5.0 + options.seconds / 5))
        first = screen.process.memory_info().rss / 1e6
        costs, draws, ratios = [], [], []
        for i in range(options.rounds):
            before = screen.draws
            console = cost(screen.process, options.seconds)
            draws.append((screen.draws - before) / options.seconds)
            bare = least(folder, str(run["domain"]), min(options.seconds, 10.0))
            costs.append(console)
            ratios.append(console / bare)
            print(f"round {i + 1}: console {console:.1f} % of a core, {draws[-1]:.1f} draws/s; the least {bare:.1f} %")
        last = screen.process.memory_info().rss / 1e6
        print(f"median ratio to the least that it takes: {statistics.median(ratios):.2f}")
        goal("per cent of a core", statistics.median(costs), 100 / 3)
        goal("draws a second", statistics.median(draws), 20)
        goal(f"MB more at the end ({first:.0f} MB in the first minute, {last:.0f} MB at the end)", last - first, 50)
    finally:
        screen.close()
        subprocess.run([*GRAPHFLOW, "down"], capture_output=True, timeout=LIMIT)


if __name__ == "__main__":
    main()
