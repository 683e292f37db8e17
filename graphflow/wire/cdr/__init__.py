"""CDR, ROS 2's payload format. Begin with `codec`; `encode` and `decode` write the functions of a type as source."""
