"""A Plan brought to life: the process tree, logs, the control socket, and how doors talk to it."""
