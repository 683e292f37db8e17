"""Mistakes in users' programs that Python or ROS 2 would pass over: each module notices one kind and tells it once."""
