"""Transforms as a declaration of a class."""

from __future__ import annotations

import pytest

from graphflow import DeclarationError, Node
from graphflow.tf import TransformBuffer, Transforms


class Listener(Node):
    tf = Transforms()


class Sender(Node):
    tf = Transforms(listen=False)


def test_the_interface() -> None:
    """Checks and plans know the topics that a node listens to."""
    found = [(e.kind, e.name, e.type, e.attribute) for e in Listener.interface().endpoints]
    assert found == [
        ("subscription", "/tf", "tf2_msgs/msg/TFMessage", "tf"),
        ("subscription", "/tf_static", "tf2_msgs/msg/TFMessage", "tf"),
    ]
    assert Sender.interface().endpoints == ()


def test_on_a_node() -> None:
    """Each node has a buffer of its own, on remapped topics."""
    first, second = Listener("first", remap=["/tf:=/robot1/tf"]), Listener("second")
    assert isinstance(first.tf, TransformBuffer)
    assert first.tf is not second.tf
    assert [e.name for e in first.endpoints if "tf" in e.name] == ["/robot1/tf", "/tf_static"]
    assert isinstance(Listener.tf, Transforms)


@pytest.mark.parametrize("cache", [0, -1, "10", True, float("nan")])
def test_a_wrong_cache(cache: object) -> None:
    """The error has the line."""
    with pytest.raises(DeclarationError, match=r"test_declaration.py:\d+: Transforms: cache is a number of seconds"):
        Transforms(cache)  # type: ignore[arg-type]
