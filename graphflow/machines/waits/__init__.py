"""The theory of deadlocks: the wait-for graph of a snapshot, its reduction, its rings, and the remedies.

Begin with `wait_graph`, the model. `reduction` decides which activities are deadlocked, `rings` selects the cycle that
shows why, `remedies` derives the changes that break it, and `explain` writes the report. All of it is pure: snapshots
in, text out. `graphflow.deadlock` takes the snapshots.
"""
