"""A graph file's blocks taken apart until nodes and steps are left. Begin with `expand`."""
