"""Recordings of topics that ROS 2's tools, and all that read MCAP, open: written, read, played.

from graphflow.bag import read

for said in read("rosbag2_2026_11_23-12_00_00"):
    print(said.topic, said.time_ns, said.message)
"""

from graphflow.bag.typed import BagMessage, read

__all__ = ["BagMessage", "read"]
