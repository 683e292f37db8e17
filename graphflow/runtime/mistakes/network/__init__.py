"""Mistakes that only the graph shows: names and domains that do not match, services that no node offers."""
