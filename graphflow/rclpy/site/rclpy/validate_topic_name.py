"""Validation of topic and service names before expansion."""

from __future__ import annotations

import re

from rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException

TOPIC_SEPARATOR_STRING = "/"
_ALLOWED = re.compile(r"[A-Za-z0-9_/~{}]")


def fault_of(name: str) -> tuple[str, int] | None:
    """Return the fault of a name and its position; None if it is legal."""
    if not name:
        return "topic name must not be empty string", 0
    for index, letter in enumerate(name):
        if not _ALLOWED.match(letter):
            return "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'", index
        if letter == "~" and index:
            return "topic name must not have tilde '~' unless it is the first character", index
    if name.endswith("/"):
        return "topic name must not end with a forward slash", len(name) - 1
    if name.startswith("~") and len(name) > 1 and name[1] != "/":
        return "topic name must not have anything but a forward slash after a tilde '~'", 1
    twice = name.find("//")
    if twice >= 0:
        return "topic name must not contain repeated '/'", twice + 1
    number = re.search(r"(?:^|/)([0-9])", name)
    if number:
        return "topic name token must not start with a number", number.start(1)
    brace = _unbalanced_brace(name)
    return None if brace is None else ("topic name must not have unbalanced curly braces '{}'", brace)


def _unbalanced_brace(name: str) -> int | None:
    for index in (i for i, letter in enumerate(name) if letter in "{}"):
        before = name[:index]
        if (name[index] == "{") == (before.count("{") > before.count("}")):
            return index
    return name.rindex("{") if name.count("{") != name.count("}") else None


def validate_topic_name(name: str, *, is_service: bool = False) -> bool:
    """Return True for a legal name; raise InvalidTopicNameException or InvalidServiceNameException otherwise."""
    return raise_fault(name, fault_of(name), is_service=is_service)


def raise_fault(name: str, fault: tuple[str, int] | None, *, is_service: bool) -> bool:
    """Raise the error for a topic name's fault and its position; return True if there is none."""
    if fault is None:
        return True
    text, index = fault
    if is_service:
        raise InvalidServiceNameException(name, text.replace("topic", "service", 1), index)
    raise InvalidTopicNameException(name, text, index)
