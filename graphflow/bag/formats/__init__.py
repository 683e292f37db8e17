"""The files of bags: MCAP, rosbag2's `.db3`, ROS 1's `.bag`, and the metadata and compression beside them."""
