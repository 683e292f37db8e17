"""A simulated robot as its users see it: the age of scans in another process, the mapper's cost, and viewers' cost.

The age of a scan is from its sending, right after the physics' step and the rays, to its handler in another process.
Goal: a median of at most 5 ms. Viewers get images of 320 x 240 at 30 Hz beside everything else.
"""

from __future__ import annotations

import asyncio
import os
import secrets
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import psutil

from benchmarks.rounds import goal
from graphflow import Node
from graphflow.maps import Mapper
from graphflow.msgs.sensor_msgs.msg import Image, LaserScan
from graphflow.msgs.std_msgs.msg import Header
from graphflow.qos import SENSOR_DATA
from graphflow.runtime.context import Context
from graphflow.runtime.node_core import core_of
from graphflow.simulator import simulate
from graphflow.tf import Pose2D
from graphflow.wire.attachment import MessageInfo

SECONDS = 8.0
GRAPHFLOW = [sys.executable, "-m", "graphflow"]


async def ages() -> list[float]:
    """Milliseconds from the sending of each scan to its handler in this process."""
    context = await Context.open()
    node, found = Node("benchmark"), list[float]()

    def take(_: LaserScan, info: MessageInfo) -> None:
        found.append((time.time_ns() - info.source_ns) / 1e6)

    node.create_subscription(LaserScan, "/scan", take, SENSOR_DATA, takes_info=True)
    await core_of(node).start(context)
    await asyncio.sleep(SECONDS)
    await core_of(node).stop()
    await context.close()
    return found[5:]


def mapping() -> float:
    """Milliseconds that the mapper needs for a scan of 360 beams: the median of a drive."""
    simulation, mapper = simulate("house", 1), Mapper()
    robot = simulation.robots[""]
    lidar = robot.robot.lidar
    assert lidar is not None
    angles = np.linspace(0.0, 2 * np.pi, lidar.beams, endpoint=False)
    costs = []
    for tick in range(round(20.0 / simulation.tick_seconds)):
        simulation.tick()
        if tick % 40 == 0:
            robot.command(0.2, 0.0 if tick % 400 else 0.5)
            ranges = robot.scan().astype(float)
            seen = np.isfinite(ranges)
            points = np.stack([np.cos(angles), np.sin(angles)], axis=1)[seen] * ranges[seen, None]
            odometry = robot.odometry
            start = time.process_time()
            mapper.add(points, np.zeros((0, 2)), Pose2D(odometry.x, odometry.y, odometry.yaw), Pose2D(-0.032, 0.0, 0.0))
            costs.append((time.process_time() - start) * 1e3)
    return statistics.median(costs)


async def images(seconds: float) -> None:
    """Publish images at 30 Hz."""
    context = await Context.open()
    node = Node("camera")
    publisher = node.create_publisher(Image, "/camera/image_raw", 5)
    await core_of(node).start(context)
    pixels = np.random.default_rng(0).integers(0, 255, 320 * 240 * 3, dtype=np.uint8)
    for _ in range(round(30 * seconds)):
        header = Header(stamp=node.clock.now(), frame_id="lens")
        publisher.publish(Image(header=header, encoding="rgb8", width=320, height=240, step=960, data=pixels))
        await asyncio.sleep(1 / 30)
    await core_of(node).stop()
    await context.close()


def _started(words: list[str]) -> subprocess.Popen[bytes]:
    return subprocess.Popen([*GRAPHFLOW, "view", *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


async def viewer(words: list[str], watch: Any) -> float:
    """Percent of a core that a viewer's server takes while it sees 30 images a second."""
    process = await asyncio.to_thread(_started, words)
    try:
        watching = asyncio.ensure_future(watch())
        sending = asyncio.ensure_future(images(SECONDS))
        await asyncio.sleep(3.0)
        used = psutil.Process(process.pid).cpu_times()
        await asyncio.sleep(SECONDS - 4.0)
        after = psutil.Process(process.pid).cpu_times()
        await sending
        watching.cancel()
        return 100 * (after.user + after.system - used.user - used.system) / (SECONDS - 4.0)
    finally:
        process.terminate()
        process.wait(10)


async def foxglove() -> None:
    """Subscribe to the images as Foxglove does, and read them."""
    import json

    from websockets.asyncio.client import connect
    from websockets.typing import Subprotocol

    await asyncio.sleep(1.5)
    async with connect("ws://127.0.0.1:18765", subprotocols=[Subprotocol("foxglove.sdk.v1")], max_size=None) as socket:
        async for message in socket:
            if isinstance(message, str) and '"advertise"' in message:
                channels = [c for c in json.loads(message)["channels"] if c["topic"] == "/camera/image_raw"]
                wanted = [{"id": 1, "channelId": channel["id"]} for channel in channels]
                if wanted:
                    await socket.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))


async def nothing() -> None:
    """Watch nothing: Rerun subscribes by itself."""


def main() -> None:
    os.environ["GRAPHFLOW_RENDEZVOUS"] = f"tcp/127.0.0.1:{20_000 + secrets.randbelow(20_000)}"
    os.environ["ROS_DOMAIN_ID"] = str(100 + secrets.randbelow(100))
    up = subprocess.run([*GRAPHFLOW, "up", "-d", "graphs/tb_sim.yaml"], capture_output=True, check=False)
    if up.returncode:
        sys.exit(up.stderr.decode())
    try:
        found = sorted(asyncio.run(ages()))
    finally:
        subprocess.run([*GRAPHFLOW, "down"], capture_output=True, check=False)
    median, late = statistics.median(found), found[int(0.95 * len(found))]
    print(f"scan age      median {median:6.2f} ms, 95 % below {late:.2f} ms, {len(found)} scans")
    goal("the median age of a scan in ms", median, 5.0)
    print(f"mapper        median {mapping():6.2f} ms a scan of 360 beams")
    served = asyncio.run(viewer(["--port", "18765"], foxglove))
    print(f"view          {served:6.1f} % of a core for 30 images a second, read by one viewer")
    with tempfile.TemporaryDirectory() as folder:
        shown = asyncio.run(viewer(["--rerun", "--save", str(Path(folder, "a.rrd"))], nothing))
    print(f"view --rerun  {shown:6.1f} % of a core for the same, written to a file")


if __name__ == "__main__":
    main()
