"""The waits of rclpy programs, as the deadlock detector reads them. Begin with `waiting`."""
