"""Next steps for errors of rclpy programs. Begin with `lookup`, which is called when an error is shown."""
