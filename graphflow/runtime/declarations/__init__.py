"""Declarations of a node class, merged with its parents' and checked.

Start with `declare` (attributes) and `handlers` (methods); `binding` applies both to a node.
"""
