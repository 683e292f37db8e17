"""Mistakes in the units of angles, times and scales; each module finds one kind."""
