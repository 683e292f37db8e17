"""Projects and ROS 2 workspaces on disk: packages, executables, shares, installed distributions. Nothing is run.

Begin with `project` (graphflow's own) and `packages` (ROS's). Imports the pure layer only.
"""
