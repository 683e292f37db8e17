"""The hint for a mistake, for tests of each kind."""

from __future__ import annotations

from collections.abc import Callable

from graphflow.rclpy.hints import lookup


def hint_of(fn: Callable[[], object]) -> str:
    """The hint for what `fn` raises."""
    try:
        fn()
    except BaseException as error:
        return lookup.hint(error)
    raise AssertionError("nothing was raised")
