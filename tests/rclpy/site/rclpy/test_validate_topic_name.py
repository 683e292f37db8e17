"""Names."""

from __future__ import annotations

import pytest

from rclpy.exceptions import NameValidationException
from rclpy.validate_topic_name import validate_topic_name


@pytest.mark.parametrize("name", ["chatter", "~/chatter", "{node}/chatter", "/a/b", "~"])
def test_a_legal_name_is_that(name: str) -> None:
    """True is what code compares with."""
    assert validate_topic_name(name) is True


@pytest.mark.parametrize(
    ("name", "text", "index"),
    [
        ("", "empty", 0),
        ("a?", "must not contain", 1),
        ("a/", "end with a forward slash", 1),
        ("a//b", "repeated", 2),
        ("a/4b", "start with a number", 2),
        ("a~", "tilde", 1),
        ("~a", "after a tilde", 1),
        ("{a", "unbalanced", 0),
        ("a}", "unbalanced", 1),
    ],
)
def test_a_wrong_name_is_refused_with_the_place(name: str, text: str, index: int) -> None:
    """In rclpy's words."""
    with pytest.raises(NameValidationException, match=text) as refused:
        validate_topic_name(name)
    assert refused.value.invalid_index == index
