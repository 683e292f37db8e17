"""`python -m graphflow.rclpy FILE ...`, `python -m graphflow.rclpy PACKAGE EXECUTABLE ...`, `... -m MODULE FILE`."""

import sys

from graphflow.rclpy.programs import main

if __name__ == "__main__":
    main(sys.argv[1:])
