"""The verbs that ROS 2 has, one module each."""
