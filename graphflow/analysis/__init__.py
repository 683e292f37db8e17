"""Static analysis of users' programs: classes, handlers, waits and mistakes, read from source without running it.

Begin with `syntax`, which parses each file once and has the walker that all modules share, and with `class_source`.
`deadlock_check` and `rclpy_check` find deadlocks before anything runs; the run-time detector in `deadlock` uses the
rest. Imports the pure layer, `workspace`, `markup` and `graph`.
"""
