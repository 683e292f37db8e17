"""Mistakes in rclpy programs that one call or the source reveals: each module reports one kind."""
