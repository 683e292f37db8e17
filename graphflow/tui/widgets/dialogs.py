"""Dialogs: a choice by key, a line of text, and a list to pick from."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, ClassVar, NamedTuple

from rich.style import Style
from rich.text import Text
from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.fuzzy import Matcher
from textual.screen import ModalScreen
from textual.widgets import Button, Input, Label, OptionList, Static
from textual.widgets.option_list import Option

from graphflow.tui.widgets.colours import colours_of


class Choice(NamedTuple):
    """One answer to a question."""

    key: str
    word: str
    """The label of the button."""


class Ask(ModalScreen[str | None]):
    """A question with a few answers, each with a key and a button. The result is the answer's key, or None."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "dismiss(None)", show=False)]

    def __init__(self, question: str, choices: Sequence[Choice], detail: str = "") -> None:
        super().__init__()
        self._question, self._choices, self._detail = question, choices, detail

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog"):
            yield Label(self._question, classes="question", markup=False)
            if self._detail:
                yield Static(self._detail, classes="detail", markup=False)
            with Vertical(classes="answers"):
                for choice in self._choices:
                    # Textual reads the labels of buttons as markup, in which [ begins a tag.
                    yield Button(f"[{choice.key}] {choice.word}".replace("[", r"\["), name=choice.key)
                yield Button(r"\[esc] back", name="")

    def on_mount(self) -> None:
        """Focus the last button, which cancels, so that an accidental enter does no harm."""
        for button in list(self.query(Button))[-1:]:  # no button, if the console is being left at this moment
            button.focus()

    def on_button_pressed(self, event: Button.Pressed) -> None:
        self.dismiss(event.button.name or None)

    def on_key(self, event: events.Key) -> None:
        if event.character in {choice.key for choice in self._choices}:
            event.stop()
            self.dismiss(event.character)
        elif event.key in ("up", "down"):
            event.stop()
            (self.focus_previous if event.key == "up" else self.focus_next)()


class AskToStop(Ask):
    """The question whether to leave or to stop the graph. Ctrl-C, which opens it, is no answer."""


class AskLine(ModalScreen[str | None]):
    """An input of one line. The result is None if it was cancelled."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "dismiss(None)", show=False)]

    def __init__(self, question: str, value: str = "") -> None:
        super().__init__()
        self._question, self._value = question, value

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog"):
            yield Label(self._question, classes="question", markup=False)
            yield Input(self._value)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        self.dismiss(event.value)


class Item(NamedTuple):
    """An entry of a list to pick from."""

    text: str
    detail: str
    value: Any


SHOWN = 200
"""Maximum entries shown at once; typing narrows the list."""


class Pick(ModalScreen[Any]):
    """A list to pick from, searched by typing parts of a name. The result is the value, or None if cancelled."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss(None)", show=False),
        Binding("down", "step(1)", show=False),
        Binding("up", "step(-1)", show=False),
        Binding("pagedown", "step(10)", show=False),
        Binding("pageup", "step(-10)", show=False),
    ]

    def __init__(self, question: str, items: Iterable[Item], empty: str = "nothing there") -> None:
        super().__init__()
        self._question, self._items, self._empty = question, list(items), empty
        self._found: list[Item] = []

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog wide"):
            yield Label(self._question, classes="question", markup=False)
            yield Input(placeholder="type to find; ↑↓ choose; enter takes; esc back")
            yield OptionList()

    def on_mount(self) -> None:
        self._show("")

    def _show(self, wanted: str) -> None:
        if wanted:
            matcher = Matcher(wanted)
            ranked = [(_rank(item, wanted.lower(), matcher), item) for item in self._items]
            ranked.sort(key=lambda pair: pair[0], reverse=True)
            self._found = [item for (_, score), item in ranked if score > 0][:SHOWN]
        else:
            self._found = self._items[:SHOWN]
        options = self.query_one(OptionList)
        options.clear_options()
        dim = colours_of(self).dim
        room = min(100, int(self.app.size.width * 0.95)) - 10
        longest = max((len(item.detail) for item in self._found), default=0)
        widest = max((len(item.text) for item in self._found), default=0)
        width = min(widest, max(room // 2, room - longest - 2))
        nothing = f"no match for {wanted!r}" if wanted and self._items else self._empty
        options.add_options(
            [Option(_line(item, width, room, dim)) for item in self._found] or [Option(nothing, disabled=True)]
        )
        options.highlighted = 0 if self._found else None

    def add(self, items: Iterable[Item]) -> None:
        """Add entries while the list is open."""
        self._items += items
        if self.is_mounted:
            self._show(self.query_one(Input).value)

    def on_input_changed(self, event: Input.Changed) -> None:
        self._show(event.value)

    def action_step(self, step: int) -> None:
        options = self.query_one(OptionList)
        if self._found:
            options.highlighted = max(0, min(len(self._found) - 1, (options.highlighted or 0) + step))

    def on_input_submitted(self) -> None:
        at = self.query_one(OptionList).highlighted
        if self._found and at is not None:
            self.dismiss(self._found[at].value)

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        if self._found:
            self.dismiss(self._found[event.option_index].value)


def _rank(item: Item, wanted: str, matcher: Matcher) -> tuple[int, float]:
    """Rank an entry for a search: by whole name, first word, beginning, substring, or scattered letters."""
    name = item.text.lower()
    nearness = (name == wanted, wanted in name.split(), name.startswith(wanted), wanted in name)
    rank = next((len(nearness) - i for i, is_so in enumerate(nearness) if is_so), 0)
    return rank, matcher.match(f"{item.text} {item.detail}")


def _line(item: Item, width: int, room: int, dim: Style) -> Text:
    text = Text(item.text, no_wrap=True)
    text.truncate(width, overflow="ellipsis", pad=True)
    text.append("  ").append(item.detail, style=dim)
    text.truncate(max(10, room), overflow="ellipsis")
    return text


class Note(ModalScreen[None]):
    """A text to read, dismissed by certain keys."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape,q,enter,f1", "dismiss", show=False)]

    def __init__(self, title: str, body: Callable[[], Any]) -> None:
        super().__init__()
        self._title, self._body = title, body

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog wide tall"):
            yield Label(f"{self._title}   (esc closes)", classes="question", markup=False)
            yield self._body()
