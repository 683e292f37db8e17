"""Conversion of structured arrays to plain ones, from NumPy."""

from __future__ import annotations

from numpy.lib.recfunctions import structured_to_unstructured

__all__ = ["structured_to_unstructured"]
