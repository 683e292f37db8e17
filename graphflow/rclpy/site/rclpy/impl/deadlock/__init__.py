"""The waits of rclpy programs, as graphflow's deadlock detector reads them. Begin with `waiting`."""
