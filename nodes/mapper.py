"""A map from a robot's laser scans, which also corrects its odometry: simultaneous localization and mapping.

    graphflow up graphs/tb_map.yaml
    graphflow map show
    graphflow map save house

It needs `scan` and the transforms `odom -> base_footprint -> base_scan`; it publishes the map on `map` and the
transform `map -> odom`, as slam_toolbox and cartographer do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import graphflow
from graphflow import Node, Param, Publisher, Time, TransformError, service, subscription, timer
from graphflow.maps import Mapper as Map
from graphflow.msgs.nav_msgs.msg import OccupancyGrid
from graphflow.msgs.nav_msgs.srv import GetMap
from graphflow.msgs.sensor_msgs.msg import LaserScan
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.qos import LATCHED, SENSOR_DATA
from graphflow.tf import Transform, Transforms

BACK = 1.0
"""Seconds by which the time of a scan jumps back when a simulation, or a bag, begins again."""


class Mapper(Node):
    """Map the surroundings, and find the robot's place in them."""

    resolution = Param(0.05, unit="m", gt=0.005, le=1.0, read_only=True, doc="The size of a cell of the map.")
    map_frame = Param("map", read_only=True, doc="The frame of the map.")
    odom_frame = Param("odom", read_only=True, doc="The frame of the odometry.")
    base_frame = Param("base_footprint", read_only=True, doc="The frame of the robot.")
    max_range = Param(0.0, unit="m", ge=0.0, doc="Ranges beyond are left out; 0 for the scanner's own limit.")
    patience = Param(0.3, unit="s", gt=0.0, doc="How long a scan waits for its transforms.")
    tf = Transforms()
    map_topic = Publisher(OccupancyGrid, "map", LATCHED)

    async def on_start(self) -> None:
        self.map = Map(self.resolution)
        self.latest, self.shown = Time(0), 0

    @subscription(LaserScan, "scan", SENSOR_DATA)
    async def scanned(self, scan: LaserScan) -> None:
        stamp = Time.from_msg(scan.header.stamp)
        if (self.latest - stamp).seconds > BACK:
            self.log.info("the time has jumped back; the map begins again")
            self.map.clear()
        self.latest = stamp
        try:
            odometry = await self.tf.lookup(self.odom_frame, self.base_frame, stamp, timeout=self.patience)
            scanner = await self.tf.lookup(self.base_frame, scan.header.frame_id, stamp, timeout=self.patience)
        except TransformError as error:
            self.log.warning("a scan is left out: %s", error, throttle=5.0)
            return
        self.map.add(*self.points(scan), odometry.planar, scanner.planar)
        if self.map.is_full:
            self.log.warning("the map has reached its largest size; what lies beyond is left out", throttle=60.0)
        x, y, yaw = self.map.correction.x, self.map.correction.y, self.map.correction.yaw
        self.tf.send(Transform.of(self.map_frame, self.odom_frame, (x, y, 0.0), rpy=(0.0, 0.0, yaw), stamp=stamp))

    def points(self, scan: LaserScan) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where the beams of a scan ended, and known free points of the others, of shape (n, 2) each."""
        ranges = np.asarray(scan.ranges, dtype=np.float64)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        longest = min(scan.range_max, self.max_range or scan.range_max)
        hit = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= longest)
        # A single beam without an echo may be a dropout; three in a row look into the open.
        beyond = np.isposinf(ranges) | (np.isfinite(ranges) & (ranges > longest))
        beyond &= np.roll(beyond, 1) & np.roll(beyond, -1)
        return directions[hit] * ranges[hit, None], directions[beyond] * longest

    @timer(1.0)
    async def publish(self) -> None:
        """Publish the map if it has changed."""
        if self.map.drawn != self.shown:
            self.shown = self.map.drawn
            self.map_topic.publish(self.map.map().to_msg(self.map_frame, self.clock.now()))

    @service(GetMap, "dynamic_map")
    async def get_map(self, request: GetMap.Request) -> GetMap.Response:
        return GetMap.Response(map=self.map.map().to_msg(self.map_frame, self.clock.now()))

    @service(Empty, "~/reset")
    async def reset(self, request: Empty.Request) -> Empty.Response:
        """Forget the map."""
        self.map.clear()
        return Empty.Response()


if __name__ == "__main__":
    graphflow.run(Mapper)
