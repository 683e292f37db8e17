"""The command line: ROS 2's verbs, and those of graphs. One module a verb group, imported when it is used."""
