"""Names that contain a Param."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow import Client, DeclarationError, Node, Param, Publisher, Subscription, subscription
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.std_msgs.msg import String

WHY = "a name cannot be made of the Param 'robot', whose value belongs to a node; write self.{}(...) with self.robot in"


def _in_text() -> None:
    class Robot(Node):
        other = Param("r1")
        robot = Param("r1")

        @subscription(String, f"{robot}/in")
        def heard(self, message: String) -> None: ...


def _as_name() -> None:
    class Robot(Node):
        robot: Any = Param("r1")
        out = Publisher(String, robot)


def _of_a_client() -> None:
    class Robot(Node):
        robot = Param("r1")
        adder = Client(AddTwoInts, f"/{robot}/add")


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (_in_text, f"@subscription: {WHY.format('create_subscription')}"),
        (_as_name, f"Publisher: {WHY.format('create_publisher')}"),
        (_of_a_client, f"Client: {WHY.format('create_client')}"),
    ],
)
def test_it_is_named(make: Any, told: str) -> None:
    """With the way to make a name of its value."""
    with pytest.raises(DeclarationError) as raised:
        make()
    assert told in str(raised.value)


def test_other_texts() -> None:
    """A plain variable of the class body may be a part of a name."""

    class Robot(Node):
        robot = Param("r1")
        prefix = "left"
        out = Publisher(String, f"{prefix}/out")
        heard = Subscription(String, f"{prefix}/in")

    assert [e.name for e in Robot.interface().endpoints if e.attribute] == ["left/out", "left/in"]
