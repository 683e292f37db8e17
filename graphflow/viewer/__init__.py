"""A running graph in viewers that speak Foxglove's WebSocket protocol: Foxglove, Lichtblick, PlotJuggler.

Only this package imports `websockets`, which comes with the extra `view`.
"""
