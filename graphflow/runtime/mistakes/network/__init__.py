"""Mistakes that only the graph shows: names and domains that do not meet, servers that nobody offers."""
