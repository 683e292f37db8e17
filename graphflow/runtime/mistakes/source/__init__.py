"""Mistakes in the source of a node class that need the class itself, its declarations and parents.

`shadowing` raises when the class is described. `slips` runs all that only warn, and those of `analysis.mistakes`, when
a node opens and in `graphflow check`. `foreseen` runs, in `graphflow check` alone, those that a running node reports
as they occur.
"""
