"""Interfaces by their names."""

from __future__ import annotations

import pytest
from example_interfaces.action import Fibonacci
from rosidl_runtime_py.utilities import (
    get_action,
    get_interface,
    get_message,
    get_service,
    is_action,
    is_message,
    is_service,
)
from std_msgs.msg import String
from std_srvs.srv import Trigger


def test_classes_by_names() -> None:
    """Whole names, or without the kind where that is known."""
    assert get_message("std_msgs/msg/String") is get_message("std_msgs/String") is String
    assert get_service("std_srvs/srv/Trigger") is get_service("std_srvs/Trigger") is Trigger
    assert get_action("example_interfaces/action/Fibonacci") is Fibonacci
    assert get_interface("std_srvs/srv/Trigger") is Trigger
    feedback = get_interface("example_interfaces/action/Fibonacci_FeedbackMessage")
    assert feedback is Fibonacci.Impl.FeedbackMessage
    assert (is_message(String), is_service(Trigger), is_action(Fibonacci)) == (True, True, True)
    assert (is_message(Trigger), is_service(String), is_action(String)) == (False, False, False)


@pytest.mark.parametrize("name", ["String", "", "/msg/String", "std_msgs//String"])
def test_names_that_are_none(name: str) -> None:
    """They are refused with an example."""
    with pytest.raises(ValueError, match="such as std_msgs/msg/String"):
        get_interface(name)


def test_what_is_not_there() -> None:
    """A package or a name that nobody has, or one of another kind."""
    with pytest.raises(ModuleNotFoundError):
        get_message("std_msg/msg/String")
    with pytest.raises(AttributeError):
        get_message("std_msgs/msg/Strng")
    with pytest.raises(ValueError, match="full name of a service, got 'std_msgs/msg/String'"):
        get_service("std_msgs/msg/String")
