"""Messages and their types, seen from outside: as text, by field, in rates and units."""
