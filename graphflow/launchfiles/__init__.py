"""ROS 2's launch files in YAML, XML and Python as the tree of a graph file.

Begin with `reading`, which takes any of them; `conversion` converts the YAML dialect, which the others become first.
Imports the pure layer, `markup` and `workspace`.
"""
