"""Drawings of characters: directed graphs and curves."""
