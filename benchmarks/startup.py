"""How long `graphflow up` takes until the first message, beside two plain Python processes that talk over raw Zenoh.

Goal: 400 ms for a graph of two nodes. Where Python keeps no bytecode (PYTHONDONTWRITEBYTECODE, or an installation that
cannot be written), each start compiles graphflow; this is measured, too, and `graphflow doctor` tells of it.
"""

from __future__ import annotations

import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import graphflow
from benchmarks.rounds import compare, goal
from graphflow.transport.rendezvous import free_endpoint

GRAPH = Path(__file__).parents[1] / "graphs" / "talker_listener.yaml"
GRAPHFLOW = [sys.executable, "-m", "graphflow.cli.main"]
RAW_LISTENER = """
import json, sys, time, zenoh
c = {"mode": "peer", "listen": {"endpoints": [sys.argv[1]]}, "scouting": {"delay": 0, "multicast": {"enabled": False}}}
s = zenoh.open(zenoh.Config.from_json5(json.dumps(c)))
sub = s.declare_subscriber("a/b", lambda m: print(time.time(), flush=True))
time.sleep(60)
"""
RAW_TALKER = """
import json, sys, time, zenoh
c = {"mode": "peer", "connect": {"endpoints": [sys.argv[1]], "retry": {"period_init_ms": 20, "period_max_ms": 200}},
     "scouting": {"delay": 0, "multicast": {"enabled": False}}}
s = zenoh.open(zenoh.Config.from_json5(json.dumps(c)))
p = s.declare_publisher("a/b")
while True:
    p.put(b"hello")
    time.sleep(0.001)
"""


def uncompiled(folder: Path) -> Path:
    """Put a copy of graphflow without bytecode into a folder; returns the folder."""
    package = Path(graphflow.__file__).parent
    shutil.copytree(package, folder / "graphflow", ignore=shutil.ignore_patterns("__pycache__"))
    return folder


def first_message(copy: Path | None = None) -> float:
    """Milliseconds from the command until the listener has heard something, by the time in its log line.

    Args:
        copy: The folder of another graphflow, which is compiled each time.
    """
    other = {"PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(copy)} if copy is not None else {}
    began = time.time()
    up = subprocess.Popen(
        [*GRAPHFLOW, "up", str(GRAPH), "rate:=1000"],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        cwd=copy,
        env=os.environ | other,
    )
    assert up.stdout is not None
    for line in up.stdout:
        heard = re.search(rb"\[INFO\] \[(\d+\.\d+)\] \[listener\]", line)
        if heard:
            up.terminate()
            up.communicate(timeout=20)
            return (float(heard[1]) - began) * 1000
    raise AssertionError("the graph ended")


def first_raw_message() -> float:
    """The same for two scripts over raw Zenoh, which link to each other directly."""
    endpoint = free_endpoint()
    began = time.time()
    listener = subprocess.Popen([sys.executable, "-c", RAW_LISTENER, endpoint], stdout=subprocess.PIPE)
    talker = subprocess.Popen([sys.executable, "-c", RAW_TALKER, endpoint])
    assert listener.stdout is not None
    heard = float(listener.stdout.readline())
    for process in (talker, listener):
        process.kill()
        process.wait()
    listener.stdout.close()
    return (heard - began) * 1000


def whole(*command: str) -> float:
    """Milliseconds of a whole process."""
    began = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return (time.perf_counter() - began) * 1000


def own_machine() -> Path:
    """Give this process and its children a rendezvous, a domain and folders of their own; returns the folder."""
    folder = tempfile.mkdtemp()
    os.environ.update(
        GRAPHFLOW_RENDEZVOUS=free_endpoint(),
        GRAPHFLOW_DOMAIN=str(random.randrange(10_000, 1_000_000)),
        XDG_RUNTIME_DIR=folder,
        XDG_STATE_HOME=folder,
    )
    return Path(folder)


def main() -> None:
    copy = uncompiled(own_machine())
    found = compare(
        {
            "two scripts, raw zenoh": first_raw_message,
            "graphflow up, 2 nodes": first_message,
            "the same, without bytecode": lambda: first_message(copy),
        },
        rounds=15,
        unit="ms",
        baseline="two scripts, raw zenoh",
    )
    goal("graphflow up to first message, ms", found["graphflow up, 2 nodes"][0], 400)


if __name__ == "__main__":
    main()
