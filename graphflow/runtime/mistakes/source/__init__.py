"""Mistakes that the source of a node class shows before or while it runs: each module finds one kind."""
