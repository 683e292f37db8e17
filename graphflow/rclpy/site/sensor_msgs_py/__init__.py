"""Messages of sensors as arrays."""
