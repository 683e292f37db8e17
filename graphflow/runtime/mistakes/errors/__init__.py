"""Advice on Python's errors: each module completes the texts of one kind."""
