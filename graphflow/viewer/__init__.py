"""A running graph in the viewers that speak Foxglove's WebSocket protocol: Foxglove, Lichtblick, PlotJuggler.

Only this room knows `websockets`, which comes with the extra `view`.
"""
