"""The verbs of ROS 2, one module each."""
