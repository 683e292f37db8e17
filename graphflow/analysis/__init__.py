"""The source of users' programs, read without running it: classes, handlers, waits, and mistakes that can be seen.

Begin with `syntax` (one parse of each file) and `class_source`. `deadlock_check` and `rclpy_check` search for
deadlocks; the run-time detector in `deadlock` asks the rest. Imports the pure layer, `workspace`, `markup` and `graph`.
"""
