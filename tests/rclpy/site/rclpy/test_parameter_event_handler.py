"""Callbacks for changes of parameters."""

from __future__ import annotations

from typing import Any

import pytest

from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_event_handler import ParameterEventHandler
from tests.rclpy.conftest import Spinner


def test_callbacks_for_one_parameter_and_for_all(node: Node, spin: Spinner) -> None:
    """The newest first, until they are removed."""
    other, told = Node("other", namespace="/ns"), list[Any]()
    other.declare_parameter("a", 1)
    handler = ParameterEventHandler(node)
    one = handler.add_parameter_callback("a", "/ns/other", lambda message: told.append(message.value.integer_value))
    handler.add_parameter_callback("a", "/ns/other", lambda message: told.append("newest"))
    every = handler.add_parameter_event_callback(lambda event: told.append(event.node))
    other.set_parameters([Parameter("a", value=5)])
    spin(lambda: len(told) == 3)
    assert told == ["newest", 5, "/ns/other"]
    handler.remove_parameter_callback(one)
    handler.remove_parameter_event_callback(every)
    with pytest.raises(RuntimeError, match="doesn't exist"):
        handler.remove_parameter_callback(one)
    with pytest.raises(RuntimeError, match="doesn't exist"):
        handler.remove_parameter_event_callback(every)
    other.set_parameters([Parameter("a", value=6)])
    spin(lambda: len(told) == 4)
    assert told[-1] == "newest"
    handler.destroy()


def test_nodes_are_named_in_full(node: Node) -> None:
    """Relative to this one's namespace; none means this one."""
    handler = ParameterEventHandler(node)
    assert handler._resolve_path() == "/node"
    assert handler._resolve_path("a") == "/a"
    assert handler._resolve_path("/b") == "/b"
