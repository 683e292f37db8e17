"""Nodes as they run.

Begin with `node` (the facade) and `node_core` (its workings); `context` is what the nodes of a process share. A node's
parts are in `endpoints`, `actions` and `parameters`; `declarations` reads a class, `mistakes` tells users of theirs.
Imports the layers below, `transport`, `executor` and `deadlock`.
"""
