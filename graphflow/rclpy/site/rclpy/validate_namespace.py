"""Validation of namespaces."""

from __future__ import annotations

import re

from rclpy.exceptions import InvalidNamespaceException


def validate_namespace(namespace: str) -> bool:
    """Return True for a legal full namespace; raise InvalidNamespaceException otherwise."""
    fault = _fault(namespace)
    if fault is not None:
        raise InvalidNamespaceException(namespace, *fault)
    return True


def _fault(namespace: str) -> tuple[str, int] | None:
    if not namespace:
        return "namespace must not be empty", 0
    if namespace == "/":
        return None
    if not namespace.startswith("/"):
        return "namespace must be absolute, it must lead with a '/'", 0
    if namespace.endswith("/"):
        return "namespace must not end with '/'", len(namespace) - 1
    wrong = re.search(r"[^A-Za-z0-9_/]", namespace)
    if wrong:
        return "namespace must not contain characters other than alphanumerics, '_', or '/'", wrong.start()
    twice = namespace.find("//")
    if twice >= 0:
        return "namespace must not contain repeated '/'", twice + 1
    number = re.search(r"/([0-9])", namespace)
    if number:
        return "namespace must not have a token that starts with a number", number.start(1)
    return None
