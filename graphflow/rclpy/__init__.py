"""rclpy's API on top of graphflow's: ROS 2 code runs unchanged once `import rclpy` is enabled.

`site/` holds the packages imported under ROS's names; the modules beside it support them. There is no ROS code in it:
everything is written from ROS 2's documentation.
"""
