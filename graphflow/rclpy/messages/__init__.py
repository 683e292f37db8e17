"""Message classes as rclpy programs expect them.

Begin with `classes`; `finder` makes them importable under ROS's names.
"""
