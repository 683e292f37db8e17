"""Messages and their types as tools need them: text, fields, rates, units and definitions."""
