"""Validation of full topic and service names."""

from __future__ import annotations

import re

from rclpy.validate_topic_name import raise_fault


def validate_full_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Return True for a legal full name; raise InvalidTopicNameException or InvalidServiceNameException otherwise."""
    return raise_fault(name, _fault(name), is_service=is_service)


def _fault(name: str) -> tuple[str, int] | None:
    if not name:
        return "topic name must not be empty", 0
    if not name.startswith("/"):
        return "topic name must be absolute, it must lead with a '/'", 0
    wrong = re.search(r"[^A-Za-z0-9_/]", name)
    if wrong:
        return "topic name must not contain characters other than alphanumerics, '_', or '/'", wrong.start()
    if name.endswith("/"):
        return "topic name must not end with '/'", len(name) - 1
    twice = name.find("//")
    if twice >= 0:
        return "topic name must not contain repeated '/'", twice + 1
    number = re.search(r"/([0-9])", name)
    if number:
        return "topic name must not have a token that starts with a number", number.start(1)
    return None
