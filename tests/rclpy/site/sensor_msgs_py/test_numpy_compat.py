"""Structured arrays as plain ones."""

from __future__ import annotations

import numpy as np
from sensor_msgs_py.numpy_compat import structured_to_unstructured


def test_points() -> None:
    """A row for each."""
    points = np.array([(1.0, 2.0), (3.0, 4.0)], [("x", "f4"), ("y", "f4")])
    assert structured_to_unstructured(points).tolist() == [[1.0, 2.0], [3.0, 4.0]]
