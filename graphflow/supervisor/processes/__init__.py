"""The processes of a graph: guardian, preload process, workers; how each starts, is watched, and ends."""
