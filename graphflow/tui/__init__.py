"""The console: a Textual door to a running graph. `main` opens it; nothing here is imported before."""
