"""rclpy's API over graphflow's, importable as `rclpy` only where asked for: code written for ROS 2 runs as it stands.

`site/` holds what is imported under ROS's names; the modules beside it are what stands behind. Nothing of ROS is in it:
it is written from what ROS 2 documents.
"""
