"""rclpy's words: told to who uses them, and the page made of the same table."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import Node
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.dictionary import WORDS, page, translation
from tests.conftest import PROJECT

NODE: Any = Node("n")


@pytest.mark.parametrize(
    ("use", "here"),
    [
        (lambda: NODE.get_logger(), 'self.log.info("...")'),
        (lambda: NODE.get_clock(), "self.clock.now()"),
        (lambda: NODE.get_parameter("x"), 'self.parameters.get("rate")'),
        (lambda: NODE.get_name(), "node.name"),
        (lambda: NODE.create_rate(10), "self.clock.every(hz=10.0)"),
        (lambda: NODE.destroy_node(), "self.shutdown() ends the node from within"),
        (lambda: NODE.create_client(AddTwoInts, "x").call_async(), "await client.call(request, timeout=2.0)"),
        (lambda: NODE.create_client(AddTwoInts, "x").wait_for_service(), "await client.wait_ready(1.0)"),
        (lambda: NODE.create_publisher(String, "x").topic_name, "here it is .name"),
    ],
)
def test_what_it_is_called_here(use: Any, here: str) -> None:
    """In the AttributeError."""
    with pytest.raises(AttributeError) as caught:
        use()
    assert here in str(caught.value)
    assert "`" not in str(caught.value)


def test_other_attributes() -> None:
    """Python's own words; and hasattr works."""
    with pytest.raises(AttributeError, match=r"^'Node' object has no attribute 'foo'$"):
        NODE.foo()
    assert not hasattr(NODE, "get_logger")
    assert getattr(NODE, "x", 1) == 1


def test_a_node_that_was_not_made() -> None:
    """Its class has forgotten to call ours."""

    class Forgot(Node):
        def __init__(self) -> None:
            self.create_publisher(String, "x", 10)

    with pytest.raises(AttributeError, match=r"^Forgot.__init__ must call super\(\).__init__\(...\) first$"):
        Forgot()


def test_no_word_is_ours() -> None:
    """An attribute that ours have too would never be translated."""
    client, publisher = NODE.create_client(AddTwoInts, "x"), NODE.create_publisher(String, "x")
    ours = {*dir(NODE), *dir(client), *dir(publisher)}
    assert not [name for word in WORDS for name in word.attributes.split() if name in ours]
    assert translation("subscribe") == ""


def test_the_page() -> None:
    """`python -m graphflow.runtime.dictionary` has made the table in the docs."""
    assert page() in (PROJECT / "docs" / "coming-from-ros2.md").read_text(encoding="utf-8")
