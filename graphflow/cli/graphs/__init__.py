"""The verbs for graphs and the console, and what they show while a graph runs."""
