"""The hook that Python imports at each start in an environment where `graphflow rclpy enable` was run.

It makes rclpy, messages and the packages of the surrounding workspace importable.
"""

import sys

from graphflow.rclpy import enabling
from graphflow.rclpy.messages import finder

if enabling.here() and not sys.flags.safe_path:  # python -P imports nothing from where it stands
    finder.search_workspace()
