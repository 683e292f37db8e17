"""How soon messages pass again after a network was gone: a graph here, a robot's router there, a cable between them.

Two network namespaces (root's right on Linux) and a cable of 50 ms each way; it is cut for ten seconds. Printed is
the time from mending it to the first message that a running `topic echo` shows. Goal: 3 s.
"""

from __future__ import annotations

import os
import select
import statistics
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.peers import finish
from benchmarks.rounds import goal
from tests.conftest import Machine, Program
from tests.network.hosts import Hosts

OUTAGE = 10.0


def once(loss: float) -> float:
    """Seconds from mending the cable to a message."""
    with Hosts() as hosts, tempfile.TemporaryDirectory() as folder:
        hosts.delay, hosts.loss = 0.05, loss
        machines = []
        for name, host in (("near", hosts.near), ("far", hosts.far)):
            (Path(folder) / name).mkdir()
            machines.append(Machine(Path(folder) / name, host.command()))
        near, far = machines
        far.env.update(GRAPHFLOW_DOMAIN=near.env["GRAPHFLOW_DOMAIN"], GRAPHFLOW_RENDEZVOUS="tcp/127.0.0.1:7447")
        try:
            far.start_python("tests/network/rmw_router.py").wait_for("router up")
            far.start("run", "nodes.turtlesim:TurtleSim").wait_for("Spawning")
            graph = near.start("up", "--connect", f"tcp/{hosts.far.address}:7447", "graphs/talker_listener.yaml")
            graph.wait_for("linked to")
            echo = near.start("topic", "echo", "/turtle1/pose", "turtlesim/msg/Pose")
            echo.wait_for("theta")
            hosts.is_cut = True
            time.sleep(OUTAGE)
            drain(echo)
            hosts.is_cut = False
            began = time.monotonic()
            echo.wait_for("theta")
            return time.monotonic() - began
        finally:
            for machine in machines:
                machine.close()


def drain(program: Program) -> None:
    """Forget what a program has printed so far."""
    assert program.process.stdout is not None
    fd = program.process.stdout.fileno()
    while select.select([fd], [], [], 0.0)[0]:
        os.read(fd, 65536)
    program.text = ""


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    for loss in (0.0, 0.02):
        times = [once(loss) for _ in range(rounds)]
        print(f"loss {loss:.0%}: " + ", ".join(f"{t:.2f}" for t in sorted(times)) + " s")
        goal("median of the return, s", statistics.median(times), 3.0)
    finish()


if __name__ == "__main__":
    main()
