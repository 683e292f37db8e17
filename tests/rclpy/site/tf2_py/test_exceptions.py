"""Why a transform cannot be had."""

from __future__ import annotations

import tf2_py
from tf2_py import exceptions


def test_all_are_caught_by_the_one_that_programs_catch() -> None:
    """`except TransformException`."""
    kinds = [getattr(tf2_py, name) for name in tf2_py.__all__ if name.endswith("Exception")]
    assert len(kinds) == 6
    assert all(issubclass(kind, exceptions.TransformException) for kind in kinds)
