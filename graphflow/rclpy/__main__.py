"""`python -m graphflow.rclpy FILE ...`, `python -m graphflow.rclpy PACKAGE EXECUTABLE ...`, `... -m MODULE FILE`."""

import os
import signal
import sys


def _end(*_: object) -> None:
    os._exit(0)  # no user code has run yet


if __name__ == "__main__":
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _end)  # until `programs.run` begins the program
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT,))  # which `graphflow run` has blocked
    from graphflow.rclpy.programs import main

    main(sys.argv[1:])
