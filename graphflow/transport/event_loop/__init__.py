"""The event loop that nodes run on, and the threads around it."""
