"""Recording topics of a running graph into a bag. Begin with `recorder`."""
