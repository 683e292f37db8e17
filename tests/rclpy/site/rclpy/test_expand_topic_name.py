"""Full names."""

from __future__ import annotations

import pytest

from rclpy.expand_topic_name import expand_topic_name


@pytest.mark.parametrize(
    ("name", "namespace", "full"),
    [
        ("a", "/ns", "/ns/a"),
        ("a", "/", "/a"),
        ("/a", "/ns", "/a"),
        ("~/a", "/ns", "/ns/me/a"),
        ("~", "/", "/me"),
        ("{node}/a", "/ns", "/ns/me/a"),
        ("{ns}/a", "/ns", "/ns/a"),
    ],
)
def test_a_name_in_full(name: str, namespace: str, full: str) -> None:
    """Relative, absolute, private, and with substitutions."""
    assert expand_topic_name(name, "me", namespace) == full


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("a?", "me", "/"), "topic name"),
        (("a", "me?", "/"), "node name"),
        (("a", "me", "ns"), "namespace"),
        (("{what}", "me", "/"), "unknown substitution"),
    ],
)
def test_what_is_wrong_is_said(arguments: tuple[str, str, str], text: str) -> None:
    """Which of the names."""
    with pytest.raises(ValueError, match=text):
        expand_topic_name(*arguments)
