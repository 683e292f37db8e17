"""The command line: ROS 2's verbs and those for graphs. One module per verb group, imported when used."""
