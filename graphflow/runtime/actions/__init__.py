"""Actions as they run: `server`, `client`, and the reasons of goals that were not reached."""
