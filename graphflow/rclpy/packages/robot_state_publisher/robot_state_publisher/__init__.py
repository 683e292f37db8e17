"""Publish a robot's links as tf2 frames, computed from its description and the positions of its joints."""
