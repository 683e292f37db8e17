"""Looking at a running graph."""
