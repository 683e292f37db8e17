#!/usr/bin/env python3
"""Write the map of a topic as a picture and a YAML file. Source: nav2_map_server map_saver_cli, its arguments."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from nav_msgs.msg import OccupancyGrid

import rclpy
from graphflow.errors import MapFileError
from graphflow.maps import GridMap, write_map
from graphflow.maps.files import FORMATS, FREE_THRESHOLD, OCCUPIED_THRESHOLD
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.utilities import remove_ros_args

PATIENCE = 5.0
"""Seconds to wait for the map."""


def main() -> None:
    """Run the program."""
    parser = argparse.ArgumentParser("map_saver_cli", description="Write the map of a topic.")
    parser.add_argument("-t", default="map", metavar="TOPIC", dest="topic", help="the topic (default map)")
    parser.add_argument("-f", metavar="NAME", dest="name", default="", help="the file's name, without an ending")
    parser.add_argument("--occ", type=float, default=OCCUPIED_THRESHOLD, help="probability of occupied cells, from")
    parser.add_argument("--free", type=float, default=FREE_THRESHOLD, help="probability of free cells, up to")
    parser.add_argument("--fmt", choices=FORMATS, default="pgm", help="the picture's format")
    parser.add_argument("--mode", choices=["trinary", "raw"], default="trinary", help="what the values mean")
    found = parser.parse_args(remove_ros_args(sys.argv)[1:])
    if not 0.0 <= found.free < found.occ <= 1.0:
        parser.error(f"--free {found.free:g} is not below --occ {found.occ:g}, or they are not between 0 and 1")
    rclpy.init()
    node, maps = Node("map_saver"), list[OccupancyGrid]()
    kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(OccupancyGrid, found.topic, maps.append, kept)
    ends = time.monotonic() + PATIENCE
    while not maps and time.monotonic() < ends:
        rclpy.spin_once(node, timeout_sec=0.1)
    if not maps:
        sys.exit(f"error: map_saver_cli: no map on {node.resolve_topic_name(found.topic)} in {PATIENCE:g} s")
    name = Path(found.name or f"map_{int(time.time())}")
    try:
        grid = GridMap.from_msg(maps[0])
        described, picture = write_map(
            grid, name, picture_format=found.fmt, mode=found.mode, occupied=found.occ, free=found.free
        )
    except (ValueError, MapFileError) as error:
        sys.exit(f"error: map_saver_cli: {error}")
    node.get_logger().info(f"Map saved: {described} and {picture}")


if __name__ == "__main__":
    main()
