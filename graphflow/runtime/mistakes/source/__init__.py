"""Mistakes in the source of a node class; each module finds one kind.

`shadowing` raises when the class is described. `slips` runs all that only warn, when a node opens and in
`graphflow check`. `foreseen` runs, in `graphflow check` alone, those that a running node reports as they occur.
`rclpy_source` has both for programs for rclpy. `name_errors` and `text_numbers` complete errors that Python raises.
"""
