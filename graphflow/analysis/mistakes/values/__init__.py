"""Mistakes in assignments, comparisons and conditions; each module finds one kind."""
