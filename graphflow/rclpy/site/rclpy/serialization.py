"""Conversion between messages and CDR."""

from __future__ import annotations

from typing import Any

from graphflow.rclpy.messages import classes


def serialize_message(message: object) -> bytes:
    """Encode a message as CDR, with its header of four bytes. Raises EncodeError if a field does not fit."""
    return classes.encode(message)


def deserialize_message(serialized_message: bytes, message_type: object) -> Any:
    """Decode a message of a class from CDR. Raises DecodeError if it is not one."""
    return classes.decode(message_type, bytes(serialized_message))
