"""A script that starts workers by a starter and prints what it hears: `KIND ROOT`.

A starter that forks must be made while its process has one thread, and so in a process of its own.
"""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from graphflow.errors import Place
from graphflow.graph.plan import PlannedNode
from graphflow.supervisor.processes.forking import ForkingStarter
from graphflow.supervisor.processes.spawning import SpawningStarter
from graphflow.supervisor.processes.starter import Starter

KINDS: dict[str, Callable[[], Starter]] = {"forking": lambda: ForkingStarter(()), "spawning": SpawningStarter}
ROOT = Path(sys.argv[2])


def planned(class_path: str) -> dict[str, Any]:
    """A node as a plan has it."""
    place = Place("graph.yaml", 1, 1)
    return asdict(PlannedNode("/a", class_path, place, place))


async def start(starter: Starter) -> None:
    """Start one worker after another, each of which ends by itself or is ended."""
    heard = asyncio.Queue[Any]()
    await starter.open(ROOT / "supervisor.log", heard.put_nowait, lambda how: print("lost", how))

    async def follow(name: str, class_path: str, env: dict[str, str], end: Callable[[str, int], None] | None) -> None:
        nodes = [planned(class_path)]
        job: Any = {"process": name, "file": "lab.yaml", "root": str(ROOT), "nodes": nodes, "debug": False}
        (log := ROOT / f"{name}.log").touch()
        starter.spawn(name, job, str(log), env)
        pid = 0
        while True:
            event = await heard.get()
            pid = event.pop("pid", pid)
            if event["event"] == "exited" or "node" in event or "error" in event:
                print(json.dumps(event), flush=True)
            if event["event"] == "exited":
                return
            if event["event"] == "spawned" and end is not None:
                while not log.read_text():
                    await asyncio.sleep(0.01)
                end(name, pid)

    await follow("wrong", "nodes.lab:Refuses", {}, None)
    await follow("leaves", "nodes.lab:Leaves", {}, None)
    await follow("fresh", "nodes.lab:Refuses", {"PYTHONHASHSEED": "7"}, None)
    await follow("impossible", "nodes.lab:Good", {"LD_A=B": "x"}, None)
    await follow("killed", "nodes.dawdles:Dawdles", {"GREETING": "good morning"}, starter.kill)
    await starter.close()


if __name__ == "__main__":
    starter = KINDS[sys.argv[1]]()
    starter.begin_probe(["nodes.lab:Good", "nodes.lab:Missing"], str(ROOT))
    found = starter.probed()
    print(sorted(found), found["nodes.lab:Missing"], flush=True)
    asyncio.run(start(starter))
    starter.end()
    print("end", flush=True)
