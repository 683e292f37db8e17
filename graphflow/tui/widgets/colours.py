"""Two themes, and the styles that views derive from the current theme."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import cycle

from rich.color import Color as RichColor
from rich.color import ColorParseError
from rich.style import Style, StyleType
from rich.text import Span, Text
from textual.app import App
from textual.theme import Theme
from textual.widget import Widget

DARK = Theme(
    name="graphflow-dark",
    primary="#6cb6ff",
    secondary="#8ddb8c",
    accent="#d2a8ff",
    foreground="#d9e2ec",
    background="#0f151c",
    surface="#141c25",
    panel="#1f2a36",
    success="#7ee08a",
    warning="#f0b35a",
    error="#ff8078",
    dark=True,
    variables={"text-muted": "#93a4b5", "block-cursor-text-style": "none", "footer-key-foreground": "#6cb6ff"},
)
LIGHT = Theme(
    name="graphflow-light",
    primary="#0a5aa8",
    secondary="#24672d",
    accent="#6b36b0",
    foreground="#1d232a",
    background="#fcfcfa",
    surface="#f3f4f1",
    panel="#e3e6e3",
    success="#1b6a2c",
    warning="#835200",
    error="#b1231b",
    dark=False,
    variables={"text-muted": "#545e68", "block-cursor-text-style": "none", "footer-key-foreground": "#0a5aa8"},
)
_NODES_DARK = ("#6cb6ff", "#8ddb8c", "#f0b35a", "#d2a8ff", "#5fd7d7", "#e6c9a8", "#c8d36b", "#ffb3e6")
_NODES_LIGHT = ("#0a5aa8", "#24672d", "#835200", "#6b36b0", "#0b6470", "#3d4a94", "#5b6100", "#96206f")
_NODES_ANSI = ("blue", "green", "yellow", "magenta", "cyan")


@dataclass(frozen=True)
class Colours:
    """The styles of one theme."""

    text: Style
    dim: Style
    strong: Style
    accent: Style
    good: Style
    warn: Style
    bad: Style
    cursor: Style
    match: Style
    nodes: tuple[Style, ...]
    is_dark: bool

    def node(self, name: str) -> Style:
        """Return the colour of a node, the same in all views."""
        # Not `hash`, which differs from process to process.
        return self.nodes[sum(name.encode()) % len(self.nodes)]

    def level(self, level: int) -> Style:
        """Return the colour of a log level, given by index."""
        return (self.dim, self.text, self.warn, self.bad, self.bad)[level]


class ThemedApp(App[str]):
    """An application as the widgets see it: with colours, and a clipboard that works in most terminals."""

    colours: Colours

    def copy(self, text: str, what: str = "") -> None:
        """Copy a text to the clipboard, and report it.

        Args:
            what: A description of the text; empty to quote the text itself.
        """
        raise NotImplementedError


def colours_of(widget: Widget) -> Colours:
    """Return the styles that a widget draws with."""
    app = widget.app
    assert isinstance(app, ThemedApp)
    return app.colours


def recolouring(old: Colours, new: Colours) -> Callable[[Text], None]:
    """Return a function that converts text from the styles of one theme to those of another."""
    names = ("match", "cursor", "bad", "warn", "good", "accent", "strong", "dim", "text")
    styles: dict[StyleType, Style] = dict(zip(old.nodes, cycle(new.nodes), strict=False))
    styles |= {getattr(old, name): getattr(new, name) for name in names}

    def recolour(text: Text) -> None:
        text.style = styles.get(text.style, text.style)
        text.spans = [Span(s.start, s.end, styles.get(s.style, s.style)) for s in text.spans]

    return recolour


def make_colours(app: ThemedApp) -> Colours:
    """Derive the styles from the current theme."""
    theme = app.current_theme
    variables = app.get_css_variables()

    def style(name: str, *, bold: bool = False) -> Style:
        # None and not False, which would switch off the bold of a style that it is added to.
        return Style(color=_colour(variables.get(name)), bold=bold or None)

    names = _NODES_ANSI if theme.ansi else _NODES_DARK if theme.dark else _NODES_LIGHT
    muted = Style(dim=True) if theme.ansi else style("text-muted")
    marked = Style(reverse=True) if theme.ansi else Style(bgcolor=_colour(variables.get("panel")))
    return Colours(
        text=Style() if theme.ansi else style("foreground"),
        dim=muted,
        strong=Style(bold=True) if theme.ansi else style("foreground", bold=True),
        accent=style("primary"),
        good=style("success"),
        warn=style("warning"),
        bad=style("error", bold=True),
        cursor=marked,
        match=style("accent", bold=True) + Style(underline=True),
        nodes=tuple(Style(color=name) for name in names),
        is_dark=theme.dark,
    )


def _colour(text: str | None) -> RichColor | None:
    """Convert a theme's colour to Rich's notation; ansi themes name theirs `ansi_blue`."""
    if text is None:
        return None
    try:
        return RichColor.parse(text.removeprefix("ansi_"))
    except ColorParseError:
        return None
