"""The verbs for graphs and the console, and their output while a graph runs."""
