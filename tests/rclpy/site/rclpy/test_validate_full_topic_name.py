"""Names."""

from __future__ import annotations

import pytest

from rclpy.exceptions import NameValidationException
from rclpy.validate_full_topic_name import validate_full_topic_name


@pytest.mark.parametrize("name", ["/a", "/a/b_1"])
def test_a_legal_name_is_that(name: str) -> None:
    """True is what code compares with."""
    assert validate_full_topic_name(name) is True


@pytest.mark.parametrize(
    ("name", "text", "index"),
    [
        ("", "empty", 0),
        ("a", "absolute", 0),
        ("/a?", "must not contain", 2),
        ("/a/", "end with", 2),
        ("/a//b", "repeated", 3),
        ("/a/4", "starts with a number", 3),
    ],
)
def test_a_wrong_name_is_refused_with_the_place(name: str, text: str, index: int) -> None:
    """In rclpy's words."""
    with pytest.raises(NameValidationException, match=text) as refused:
        validate_full_topic_name(name)
    assert refused.value.invalid_index == index
