"""A running graph in viewers: Foxglove, Lichtblick and PlotJuggler by Foxglove's WebSocket protocol, and Rerun.

Read `bridge` first, the server for viewers of the protocol; `rerun/` is the other one. Only this package imports
`websockets` and `rerun`, which come with the extras `view` and `rerun`.
"""
