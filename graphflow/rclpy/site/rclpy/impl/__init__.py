"""What code finds under this name in rclpy."""
