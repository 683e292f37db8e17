"""A node's parameters: values, checks and ROS 2's services for them."""
