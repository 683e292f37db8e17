"""Sensor messages as arrays."""
