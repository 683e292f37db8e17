#!/usr/bin/env python3
"""Print the delays of transforms and the rates of their publishers. Source: tf2_ros tf2_monitor, its output."""

from __future__ import annotations

import sys

from graphflow.errors import TransformError
from graphflow.runtime.declarations.handlers import task
from graphflow.runtime.node import Node
from graphflow.runtime.run import run
from graphflow.tf import Transforms
from graphflow.tf.text import monitored
from rclpy.utilities import remove_ros_args


class Monitor(Node):
    """Prints a summary each second: of all frames, or of the chain between two."""

    node_name = "tf2_monitor"
    tf = Transforms()
    between: tuple[str, ...] = ()

    @task
    async def print_summaries(self) -> None:
        delays: list[float] = []
        async for _ in self.clock.every(1.0):
            try:
                chain = self.tf.chain(*self.between) if self.between else []
                stamp = self.tf.get(chain[0], chain[-1]).stamp if chain else None
            except TransformError as error:
                self.log.info("waiting for %s", error)
                continue
            if stamp is not None and stamp.nanoseconds:
                delays.append((self.clock.now() - stamp).seconds)
                del delays[:-1000]
            sys.stdout.write(f"{monitored(self.tf.infos(), chain, delays)}\n\n")
            sys.stdout.flush()


def main() -> None:
    """Run the program."""
    frames = tuple(remove_ros_args(sys.argv)[1:])
    if len(frames) not in (0, 2):
        sys.exit("tf2_monitor takes two frames, or none: tf2_monitor map base_link")
    Monitor.between = frames
    run(Monitor)


if __name__ == "__main__":
    main()
