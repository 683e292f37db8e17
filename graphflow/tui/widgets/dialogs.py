"""What the console asks: one key of several, one line of text, one of many things."""

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


class Choice(NamedTuple):
    """One answer to a question."""

    key: str
    word: str
    """What the answer is, as the button says it."""


class Ask(ModalScreen[str | None]):
    """A question with a few answers, each a key and a button. The result is the answer's key, None for none."""

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
                    yield Button(f"[{choice.key}] {choice.word}".replace("[", r"\["), name=choice.key)
                yield Button(r"\[esc] back", name="")

    def on_mount(self) -> None:
        """Enter, pressed by mistake, goes back."""
        for button in list(self.query(Button))[-1:]:  # none, if the console is being left at this moment
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
    """Whether to leave or to stop the graph. Ctrl-C, the key that asks, is no answer."""


class AskLine(ModalScreen[str | None]):
    """One line of text; None when it was given up."""

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
    """One thing that can be picked."""

    text: str
    detail: str
    value: Any


SHOWN = 200
"""Things that a list shows at once; typing narrows it."""


class Pick(ModalScreen[Any]):
    """One of many things, found by typing parts of its name. The result is its value; None when it was given up."""

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
        dim = self.app.colours.dim  # type: ignore[attr-defined]
        room = min(100, int(self.app.size.width * 0.95)) - 10
        longest = max((len(item.detail) for item in self._found), default=0)
        widest = max((len(item.text) for item in self._found), default=0)
        width = min(widest, max(room // 2, room - longest - 2))
        nothing = f"nothing here is called {wanted!r}" if wanted and self._items else self._empty
        options.add_options(
            [Option(_line(item, width, room, dim)) for item in self._found] or [Option(nothing, disabled=True)]
        )
        options.highlighted = 0 if self._found else None

    def add(self, items: Iterable[Item]) -> None:
        """Offer more, as it becomes known."""
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
    """How well a thing is what was typed: by its name, its first word, its beginning, a part of it, or by letters."""
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
    """Something to read, until any of the keys that end it."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape,q,enter,f1", "dismiss", show=False)]

    def __init__(self, title: str, body: Callable[[], Any]) -> None:
        super().__init__()
        self._title, self._body = title, body

    def compose(self) -> ComposeResult:
        with Vertical(classes="dialog wide tall"):
            yield Label(f"{self._title}   (esc closes)", classes="question", markup=False)
            yield self._body()
