"""A node's logging: Python's logger with ROS 2's options, the console's line format, and /rosout."""
