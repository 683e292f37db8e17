"""Names."""

from __future__ import annotations

import pytest

from rclpy.exceptions import NameValidationException
from rclpy.validate_namespace import validate_namespace


@pytest.mark.parametrize("name", ["/", "/a/b"])
def test_a_legal_name_is_that(name: str) -> None:
    """True is what code compares with."""
    assert validate_namespace(name) is True


@pytest.mark.parametrize(
    ("name", "text", "index"),
    [
        ("", "empty", 0),
        ("a", "absolute", 0),
        ("/a/", "end with", 2),
        ("/a?", "must not contain", 2),
        ("/a//b", "repeated", 3),
        ("/1", "starts with a number", 1),
    ],
)
def test_a_wrong_name_is_refused_with_the_place(name: str, text: str, index: int) -> None:
    """In rclpy's words."""
    with pytest.raises(NameValidationException, match=text) as refused:
        validate_namespace(name)
    assert refused.value.invalid_index == index
