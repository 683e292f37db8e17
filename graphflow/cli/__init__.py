"""The command line.

Begin with `main`, which has the table of verbs; each verb's module is imported when it is used. `ros` has ROS 2's
verbs, `graphs` those for graphs; `messages` sends, shows and records; `projects` makes projects and finds nodes.
"""
