"""Names."""

from __future__ import annotations

import pytest

from rclpy.exceptions import NameValidationException
from rclpy.validate_node_name import validate_node_name


@pytest.mark.parametrize("name", ["a", "_a1"])
def test_a_legal_name_is_that(name: str) -> None:
    """True is what code compares with."""
    assert validate_node_name(name) is True


@pytest.mark.parametrize(
    ("name", "text", "index"),
    [
        ("", "empty", 0),
        ("a.b", "must not contain", 1),
        ("1a", "start with a number", 0),
    ],
)
def test_a_wrong_name_is_refused_with_the_place(name: str, text: str, index: int) -> None:
    """In rclpy's words."""
    with pytest.raises(NameValidationException, match=text) as refused:
        validate_node_name(name)
    assert refused.value.invalid_index == index
