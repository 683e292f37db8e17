"""ROS 2's launch files in YAML, XML and Python, read as graph files.

Begin with `reading`, which reads any of them; `conversion` converts the YAML dialect, which the others become first.
Imports the pure layer, `markup` and `workspace`.
"""
