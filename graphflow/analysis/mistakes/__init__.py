"""Mistakes that the source alone shows; each module finds one kind, and yields lines with a sentence.

`calls` has mistakes in what is called, passed or defined, `values` in assignments and comparisons, and `units` in
angles, times and scales. `native_source` and `rclpy_source` run them. Mistakes that need the class itself, with its
declarations and parents, are in `runtime.mistakes.source`.
"""
