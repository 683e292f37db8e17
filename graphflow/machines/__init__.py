"""Decisions: (state, event, now) -> (state, things to do). Nothing here waits, reads a clock or does I/O."""
