"""The terminal below Textual: key order and prefix, clipboard, job control, and slow terminals."""
