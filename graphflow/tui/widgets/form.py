"""A form for a message type: one line per field, filled in with its default."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, VerticalScroll
from textual.message import Message as Posted
from textual.widgets import Input, Label

from graphflow.errors import EncodeError, GraphflowError
from graphflow.introspect.messages.echo import flow, plain
from graphflow.markup.source import parse_value
from graphflow.msgs import registry
from graphflow.msgs.base import Message
from graphflow.msgs.values import from_plain

FIELDS = 60
"""Maximum lines of a form; deeper fields are written as YAML in one line."""
DEPTH = 3


class Form(VerticalScroll):
    """Input lines for the fields of a message; `message` reads them.

    Tab, enter and the arrows move between lines; enter in the last one posts `Completed`.

    Args:
        type_: The class of the message.
        past: The values of earlier messages, as `values` returned them.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("tab,down", "step(1)", show=False),
        Binding("shift+tab,up", "step(-1)", show=False),
    ]

    DEFAULT_CSS = """
    Form { height: auto; max-height: 60%; }
    Form Horizontal { height: 1; }
    Form Label { width: 24; color: $text-muted; padding: 0 1; }
    Form Input { width: 1fr; }
    Form Input.-wrong { color: $error; }
    """

    class Edited(Posted):
        """The user has changed a field."""

    class Completed(Posted):
        """Enter was pressed in the last line."""

    def __init__(self, type_: type[Message], past: Sequence[dict[str, Any]] = ()) -> None:
        super().__init__()
        self.type = type_
        self._past = [*past]
        self._at = len(self._past)
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

    def action_step(self, step: int) -> None:
        """Move to another line; the first follows the last."""
        lines = list(self.query(Input))
        if lines:
            # Without a focus, the first line is next in both directions.
            at = next((i for i, line in enumerate(lines) if line.has_focus), -step)
            self.screen.set_focus(lines[(at + step) % len(lines)])

    def on_input_submitted(self, event: Input.Submitted) -> None:
        event.stop()
        if event.input is list(self.query(Input))[-1]:
            self.post_message(self.Completed())
        else:
            self.action_step(1)

    def on_input_changed(self, event: Input.Changed) -> None:
        event.stop()
        event.input.set_class(bool(self.fault(event.input)), "-wrong")
        self.post_message(self.Edited())

    def fault(self, line: Input) -> str:
        """Return the fault of a line; empty if there is none."""
        try:
            from_plain(self.type, self._values([line]))
        except EncodeError as error:
            return str(error)
        return ""

    def first_fault(self) -> str:
        """Return the first fault and focus its line; empty if there is none."""
        for line in self.query(Input):
            if fault := self.fault(line):
                self.screen.set_focus(line)
                return fault
        return ""

    def values(self) -> dict[str, Any]:
        """Return the values that differ from the defaults, nested as in the message.

        Raises:
            EncodeError: A line is not YAML.
        """
        return self._values(self.query(Input))

    def _values(self, lines: Iterable[Input]) -> dict[str, Any]:
        found: dict[str, Any] = {}
        defaults = {path: default for path, _, default in self._fields}
        types = {path: type_name for path, type_name, _ in self._fields}
        for line in lines:
            path = str(line.name)
            if line.value == _text(defaults[path]):
                continue
            at = found
            *above, last = path.split(".")
            for part in above:
                at = at.setdefault(part, {})
            at[last] = _value(line.value, types[path], path)
        return found

    def fill(self, values: Mapping[str, object]) -> None:
        """Fill in values as returned by `values`, with defaults elsewhere."""
        for path, _, default in self._fields:
            value: object = values
            for part in path.split("."):
                value = value.get(part) if isinstance(value, dict) else None
            line = next(line for line in self.query(Input) if line.name == path)
            line.value = _text(default if value is None else value)

    def recall(self, step: int) -> str:
        """Fill in the values of an earlier or later message; the defaults follow the last.

        Returns:
            Its position, for display; empty if there is none.
        """
        if not self._past:
            return ""
        self._at = max(0, min(len(self._past), self._at + step))
        self.fill(self._past[self._at] if self._at < len(self._past) else {})
        return f"{self._at + 1} of {len(self._past)} sent before" if self._at < len(self._past) else "the defaults"

    def keep(self) -> None:
        """Add the current values to the past messages."""
        if self.values() not in self._past[-1:]:
            self._past.append(self.values())
        self._at = len(self._past) - 1

    def message(self) -> Message:
        """Return the message.

        Raises:
            EncodeError: A value does not fit; the text names the field.
        """
        return from_plain(self.type, self.values())


def form_for(type_name: str, past: Sequence[dict[str, Any]] = ()) -> Form:
    """Make a form for the type of that name; further arguments as for `Form`.

    Raises:
        GraphflowError: The type is not known here.
    """
    found: type[Message] = registry.interface_class(type_name)
    return Form(found, past)


def _leaves(message: Message, path: str, depth: int) -> Iterator[tuple[str, str, object]]:
    for field in message.SCHEMA.fields:
        value = getattr(message, field.name)
        where = f"{path}.{field.name}" if path else field.name
        if isinstance(value, Message) and depth < DEPTH:
            yield from _leaves(value, where, depth + 1)
        else:
            yield where, str(field.type), plain(value)


def _text(value: object) -> str:
    return value if isinstance(value, str) else flow(value)


def _value(text: str, type_name: str, path: str) -> object:
    if type_name in ("string", "wstring"):
        return text
    try:
        value = parse_value(text)
    except GraphflowError as error:
        raise EncodeError(f"{path}: {error}") from None
    # Not `isinstance`: True is an int, and no number for a form.
    return float(value) if type_name.startswith("float") and type(value) is int else value
