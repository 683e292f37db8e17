"""Imported at the start of each Python of an environment in which `graphflow rclpy enable` was called.

rclpy and messages can be imported then, and what lies in the workspace around.
"""

from graphflow.rclpy import enabling, finder

if enabling.here():
    finder.look_around()
