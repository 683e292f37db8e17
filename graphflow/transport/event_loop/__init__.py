"""The event loop that nodes run on, and its helper threads."""
