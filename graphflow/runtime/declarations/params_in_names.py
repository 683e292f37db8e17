"""Names of topics and services that contain a Param, which has no value before a node is made."""

from __future__ import annotations

import sys
from typing import NoReturn

from graphflow.errors import DeclarationError, Place

_MAKERS = {
    "Publisher": "create_publisher",
    "Subscription": "create_subscription",
    "@subscription": "create_subscription",
    "@service": "create_service",
    "Client": "create_client",
    "@action": "create_action_server",
    "ActionClient": "create_action_client",
}
"""The methods of a node that do the same as each declaration."""


def refuse_param(name: object, what: str, place: Place) -> None:
    """Check that the name of a topic or service is no Param, and no text with one: `f"{robot}/in"`.

    Raises:
        DeclarationError: It is; the text has the way to make a name of a parameter's value.
    """
    if not isinstance(name, str):
        if hasattr(name, "with_typing"):
            _refuse(repr(name), what, place)
    elif "<Param " in name:
        _refuse(name, what, place)


def _refuse(text: str, what: str, place: Place) -> NoReturn:
    word = _attribute(text, place)
    own, named = (f"self.{word}", f" {word!r}") if word else ("its value", "")
    maker = _MAKERS.get(what, what)
    raise DeclarationError(
        f"{place}: {what}: a name cannot be made of the Param{named}, whose value belongs to a node; write "
        f"self.{maker}(...) with {own} in __init__, or remap the name"
    )


def _attribute(text: str, place: Place) -> str:
    """Return the attribute of the class body in `place` whose representation the text contains."""
    frame = sys._getframe(1)
    while (frame.f_code.co_filename, frame.f_lineno) != (place.file, place.line):
        if frame.f_back is None:
            return ""
        frame = frame.f_back
    found = {name: value for name, value in frame.f_locals.items() if hasattr(value, "with_typing")}
    return next((name for name, value in found.items() if repr(value) in text), "")
