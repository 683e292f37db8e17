"""A Plan brought to life: the process tree, logs, the control socket, and how the command line talks to it."""
