"""The views, one module each, whose class is bound to `VIEW`."""
