"""The names that programs import from `rclpy.impl`, and the implementation behind the public classes."""
