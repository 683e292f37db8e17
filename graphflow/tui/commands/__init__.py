"""The console's keys and command line. Begin with `actions`, the table of all keys."""
