"""Mistakes in rclpy programs that only time reveals: each module watches for one kind; `watches` runs all of them."""
