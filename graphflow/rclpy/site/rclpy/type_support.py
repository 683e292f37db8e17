"""Checks that a class is a message or service class."""

from __future__ import annotations

from typing import Any, TypeVar

from rclpy.exceptions import NoTypeSupportImportedException

MsgType = TypeVar("MsgType")
SrvType = TypeVar("SrvType")
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")


def check_for_type_support(msg_or_srv_type: Any) -> None:
    """Raise AttributeError if it is not an interface class, NoTypeSupportImportedException if it lacks type support."""
    if hasattr(msg_or_srv_type, "SCHEMA") or hasattr(msg_or_srv_type, "NAME"):
        return
    kind = type(msg_or_srv_type)
    try:
        support = kind._TYPE_SUPPORT
        if support is None:
            kind.__import_type_support__()
            support = kind._TYPE_SUPPORT
    except AttributeError as error:
        text = (
            "This might be a ROS 1 message type but it should be a ROS 2 message type."
            " Make sure to source your ROS 2 workspace after your ROS 1 workspace."
        )
        raise AttributeError(f"{error} {text}") from None
    if support is None:
        raise NoTypeSupportImportedException


def check_is_valid_msg_type(msg_type: Any) -> None:
    """Raise RuntimeError if it is not a message class."""
    check_for_type_support(msg_type)
    if not hasattr(msg_type, "SCHEMA"):
        raise RuntimeError(
            "The message type provided is not valid (make sure you are using message types from messages)"
        )


def check_is_valid_srv_type(srv_type: object) -> None:
    """Raise RuntimeError if it is not a service class."""
    check_for_type_support(srv_type)
    if not (hasattr(srv_type, "Request") and hasattr(srv_type, "Response")):
        raise RuntimeError(
            "The service type provided is not valid (make sure you are using service types from services)"
        )
