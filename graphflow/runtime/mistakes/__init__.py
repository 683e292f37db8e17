"""Mistakes in user programs that Python or ROS 2 would ignore: each module detects one kind and reports it once."""
