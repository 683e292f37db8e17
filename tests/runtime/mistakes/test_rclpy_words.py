"""rclpy's names: hints in errors, and the page with the same table."""

from __future__ import annotations

from typing import Any

from graphflow import Node
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.mistakes.rclpy_words import EQUIVALENTS, page, translation
from tests.conftest import PROJECT

NODE: Any = Node("n")


def test_no_word_is_ours() -> None:
    """An attribute that ours have too would never be translated."""
    client, publisher = NODE.create_client(AddTwoInts, "x"), NODE.create_publisher(String, "x")
    ours = {*dir(NODE), *dir(client), *dir(publisher)}
    assert not [name for word in EQUIVALENTS for name in word.attributes.split() if name in ours]
    assert translation("subscribe") == ""


def test_the_page() -> None:
    """`python -m graphflow.runtime.mistakes.rclpy_words` has made the table in the docs."""
    assert page() in (PROJECT / "docs" / "coming-from-ros2.md").read_text(encoding="utf-8")
