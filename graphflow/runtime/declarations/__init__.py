"""The declarations of a node class, merged with its parents' and checked.

Begin with `declare` (what a class holds) and `handlers` (what it does); `binding` applies them to a node.
"""
