"""`python -m graphflow.rclpy FILE ...`, `python -m graphflow.rclpy PACKAGE EXECUTABLE ...`, `... -m MODULE FILE`."""

import signal
import sys

if __name__ == "__main__":
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends it without a traceback until the program begins
    from graphflow.rclpy.programs import main

    main(sys.argv[1:])
