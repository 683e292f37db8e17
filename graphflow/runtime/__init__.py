"""The runtime: nodes, their endpoints and their parameters.

Start with `node` (the facade) and `node_core` (the implementation); `context` holds the state that a
process's nodes share. A node's parts are in `endpoints`, `actions` and `parameters`. `declarations` reads node
classes, and `mistakes` reports common errors in user code. The layers below are `transport`, `executor` and `deadlock`.
"""
