"""Messages as CDR, and back."""

from __future__ import annotations

from typing import Any

from graphflow.rclpy.messages import classes


def serialize_message(message: Any) -> bytes:
    """A message as CDR, with its header of four bytes. Raises EncodeError if a field does not fit."""
    return classes.encode(message)


def deserialize_message(serialized_message: bytes, message_type: Any) -> Any:
    """The message of a class that CDR holds. Raises DecodeError if it holds none."""
    return classes.decode(message_type, bytes(serialized_message))
