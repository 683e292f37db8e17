"""Mistakes in a node class's source, found before or while it runs: each module finds one kind."""
