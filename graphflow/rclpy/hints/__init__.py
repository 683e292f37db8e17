"""The next steps for errors of rclpy programs. Begin with `lookup`, which is asked when an error is shown."""
