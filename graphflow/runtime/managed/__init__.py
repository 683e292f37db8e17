"""Lifecycle nodes: the class that users derive from, and its implementation."""
