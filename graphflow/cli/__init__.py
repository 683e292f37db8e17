"""The command line.

Begin with `main`, which has the table of verbs; a verb's module is imported only when the verb is used. `ros` has
ROS 2's verbs and `graphs` those for graphs; `messages` publishes, prints and records messages; `projects` writes new
projects and finds nodes.
"""
