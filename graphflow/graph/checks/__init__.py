"""Checks of graph files: keys and types (`validation`), order, loose ends, and names of classes (`check`)."""
