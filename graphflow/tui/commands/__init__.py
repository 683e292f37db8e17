"""The console's keys and command line: `actions` is the table of all of them; the rest carries them out."""
