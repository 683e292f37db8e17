"""A robot's links as frames of tf2: where they are follows from its description and the positions of its joints."""
