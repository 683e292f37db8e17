"""From a graph file to a running supervisor: import classes, run launch files, find programs."""
