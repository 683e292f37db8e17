"""A form made of an interface: a line for each field, filled in with its default."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from textual.app import ComposeResult
from textual.containers import Horizontal, VerticalScroll
from textual.message import Message as Posted
from textual.widgets import Input, Label

from graphflow.errors import EncodeError
from graphflow.graph.source import parse_value
from graphflow.introspect.echo import flow, plain
from graphflow.msgs import registry
from graphflow.msgs.base import Message
from graphflow.msgs.values import from_plain

FIELDS = 60
"""Lines of a form; what is nested deeper is written as YAML in one of them."""
DEPTH = 3


class Form(VerticalScroll):
    """Lines to fill in; `message` reads them.

    Args:
        type_: The class of the message to make.
    """

    DEFAULT_CSS = """
    Form { height: auto; max-height: 60%; }
    Form Horizontal { height: 1; }
    Form Label { width: 24; color: $text-muted; padding: 0 1; }
    Form Input { width: 1fr; }
    """

    class Edited(Posted):
        """Something in the form has changed."""

    def __init__(self, type_: type[Message]) -> None:
        super().__init__()
        self.type = type_
        self._fields = list(_leaves(type_(), "", 0))[:FIELDS]

    def compose(self) -> ComposeResult:
        for path, type_name, default in self._fields:
            with Horizontal():
                yield Label(f"{path}", markup=False)
                yield Input(_text(default), placeholder=type_name, name=path)
        if not self._fields:
            yield Label("nothing to fill in", markup=False)

    def on_mount(self) -> None:
        self.call_after_refresh(self._focus_first)

    def _focus_first(self) -> None:
        for line in self.query(Input):
            self.screen.set_focus(line)
            return

    def on_input_changed(self, event: Input.Changed) -> None:
        event.stop()
        self.post_message(self.Edited())

    def values(self) -> dict[str, Any]:
        """What differs from the defaults, nested as the message is.

        Raises:
            EncodeError: A line is not YAML.
        """
        found: dict[str, Any] = {}
        defaults = {path: default for path, _, default in self._fields}
        types = {path: type_name for path, type_name, _ in self._fields}
        for line in self.query(Input):
            path = str(line.name)
            if line.value == _text(defaults[path]):
                continue
            at = found
            *above, last = path.split(".")
            for part in above:
                at = at.setdefault(part, {})
            at[last] = _value(line.value, types[path], path)
        return found

    def fill(self, values: dict[str, Any]) -> None:
        """Put values in, as `values` gave them; defaults elsewhere."""
        for path, _, default in self._fields:
            value: Any = values
            for part in path.split("."):
                value = value.get(part) if isinstance(value, dict) else None
            line = next(line for line in self.query(Input) if line.name == path)
            line.value = _text(default if value is None else value)

    def message(self) -> Message:
        """The message.

        Raises:
            EncodeError: A value does not fit; the text names the field.
        """
        return from_plain(self.type, self.values())


def form_for(type_name: str) -> Form:
    """A form for a message type.

    Raises:
        GraphflowError: The type is not known here.
    """
    found: Any = registry.interface_class(type_name)
    return Form(found)


def _leaves(message: Any, path: str, depth: int) -> Iterator[tuple[str, str, Any]]:
    for field in message.SCHEMA.fields:
        value = getattr(message, field.name)
        where = f"{path}.{field.name}" if path else field.name
        if isinstance(value, Message) and depth < DEPTH:
            yield from _leaves(value, where, depth + 1)
        else:
            yield where, str(field.type), plain(value)


def _text(value: Any) -> str:
    return value if isinstance(value, str) else flow(value)


def _value(text: str, type_name: str, path: str) -> Any:
    if type_name in ("string", "wstring"):
        return text
    try:
        value = parse_value(text)
    except Exception as error:  # the reader's own kinds of error
        raise EncodeError(f"{path}: {error}") from None
    return float(value) if type_name.startswith("float") and type(value) is int else value
