"""Inspection of a running graph."""
