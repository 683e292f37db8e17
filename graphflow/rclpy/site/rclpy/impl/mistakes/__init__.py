"""Mistakes in rclpy programs that show in one call or in the source: each module reports one kind."""
