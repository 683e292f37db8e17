"""Managed (lifecycle) nodes: the class that users derive from, and its workings."""
