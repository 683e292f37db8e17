"""Names that modules have from others."""

from __future__ import annotations

from importlib import import_module

import pytest

from rclpy.impl.reexports import PASSED


@pytest.mark.parametrize("module", PASSED)
def test_each_name_is_that_of_the_module_that_it_is_from(module: str) -> None:
    """And nothing else is there."""
    here = import_module(f"rclpy.{module}")
    for source, names in PASSED[module].items():
        for name in names:
            assert getattr(here, name) is getattr(import_module(source), name)
    with pytest.raises(AttributeError, match="has no attribute 'Nobody'"):
        here.Nobody  # noqa: B018 - that it is asked for is the test


def test_messages_under_other_names() -> None:
    """As rclpy imports them."""
    from rcl_interfaces.msg import Parameter

    assert import_module("rclpy.parameter").ParameterMsg is Parameter
