"""A node's log: Python's logger with ROS 2's words, the console's line format, and /rosout."""
