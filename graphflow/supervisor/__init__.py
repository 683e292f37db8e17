"""A Plan as running processes.

Begin with `launching.launch`, the way from a graph file to `supervisor`, which carries out what `machines.process`
decides. `processes` starts, guards and ends them; `control` is the socket between a supervisor and
its clients: consoles and verbs.
"""
