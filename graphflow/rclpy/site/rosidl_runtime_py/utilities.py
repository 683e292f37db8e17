"""Interfaces by full name: `std_msgs/msg/String`, or `std_msgs/String` where the kind is known."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def get_interface(identifier: str) -> Any:
    """Return the class of an interface. Raises ValueError, ModuleNotFoundError or AttributeError if there is none."""
    return _class(identifier, None)


def get_message(identifier: str) -> Any:
    """Return the class of a message. Errors as for `get_interface`."""
    return _checked(_class(identifier, "msg"), identifier, "a message", is_message)


def get_service(identifier: str) -> Any:
    """Return the class of a service. Errors as for `get_interface`."""
    return _checked(_class(identifier, "srv"), identifier, "a service", is_service)


def get_action(identifier: str) -> Any:
    """Return the class of an action. Errors as for `get_interface`."""
    return _checked(_class(identifier, "action"), identifier, "an action", is_action)


def is_message(interface: object) -> bool:
    """Whether a class is a message class."""
    return hasattr(interface, "get_fields_and_field_types")


def is_service(interface: object) -> bool:
    """Whether a class is a service class."""
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: object) -> bool:
    """Whether a class is an action class."""
    return all(hasattr(interface, part) for part in ("Goal", "Result", "Feedback"))


def _class(identifier: str, kind: str | None) -> object:
    *namespace, name = identifier.split("/")
    if len(namespace) == 1 and kind is not None:
        namespace.append(kind)
    if not all((*namespace, name)) or not namespace:
        raise ValueError(f"Expected the full name of an interface, such as std_msgs/msg/String, got '{identifier}'")
    found: Any = import_module(".".join(namespace))
    for part in (name.rsplit("_", 1)[0], "Impl", "FeedbackMessage") if name.endswith("_FeedbackMessage") else (name,):
        found = getattr(found, part)
    return found


def _checked(interface: Any, identifier: str, what: str, is_that: Any) -> object:
    if not is_that(interface):
        raise ValueError(f"Expected the full name of {what}, got '{identifier}'")
    return interface
