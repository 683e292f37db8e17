"""Mistakes in graph files: keys and types (`validation`), order, loose ends, and what classes lack (`check`)."""
