"""Imported at the start of each Python of an environment in which `graphflow rclpy enable` was called.

rclpy and messages can be imported then, and what lies in the workspace around.
"""

import sys

from graphflow.rclpy import enabling
from graphflow.rclpy.messages import finder

if enabling.here() and not sys.flags.safe_path:  # python -P imports nothing from where it stands
    finder.look_around()
