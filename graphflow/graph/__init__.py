"""Graph files, from a tree of values to a checked plan.

Begin with `resolve`: `expand` flattens a file to nodes and steps, `model` is its grammar, `plan` the result, and
`check` compares it with the classes. Imports the pure layer, `workspace`, `markup` and `launchfiles`; runs nothing.
"""
