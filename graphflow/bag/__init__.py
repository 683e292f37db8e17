"""Recordings of topics in the formats of ROS 2's tools: write, read and play them.

from graphflow.bag import read

for record in read("rosbag2_2026_11_23-12_00_00"):
    print(record.topic, record.time_ns, record.message)
"""

from graphflow.bag.typed import BagMessage, read

__all__ = ["BagMessage", "read"]
