"""CDR, ROS 2's payload format. Start with `codec`; `encode` and `decode` generate the functions of a type."""
