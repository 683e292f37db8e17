"""The wait-for graph of a snapshot: its reduction, the rings in it, and the changes that would end them.

Begin with `wait_graph`; `reduction` decides who is dead, `rings` why, `explain` says it.
"""
