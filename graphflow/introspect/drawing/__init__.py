"""Drawings made of characters: directed graphs and curves."""
