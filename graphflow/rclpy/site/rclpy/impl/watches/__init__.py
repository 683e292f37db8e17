"""Mistakes in rclpy programs that show only in time: each module watches for one kind; `watches` runs all of them."""
