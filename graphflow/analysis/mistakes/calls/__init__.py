"""Mistakes in what a program calls, passes or defines; each module finds one kind."""
