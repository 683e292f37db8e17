"""The base class of all views, those of other packages included.

A view reads its `hub` a few times a second and draws the changes. It never waits: slow work goes through `work`, whose
result arrives on the event loop.
"""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable
from typing import ClassVar, Protocol

from textual.widget import Widget

from graphflow.errors import GraphflowError
from graphflow.tui.commands.actions import Action, carry_out
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.layout import Layout
from graphflow.tui.panes import Content
from graphflow.tui.widgets.colours import Colours, ThemedApp, colours_of

SOON = 0.1
"""Seconds by which an early update is delayed, so that a burst of events is drawn once."""


class Commands(Protocol):
    """The commands of the console that views and bars use."""

    def do_close_pane(self) -> None: ...

    def do_detach(self) -> None: ...

    def do_groups(self) -> None: ...

    def do_help(self) -> None: ...

    def go_to_window(self, number: int) -> None: ...

    def do_command(self) -> None: ...

    def do_mute_node(self) -> None: ...

    def restart(self, node: str) -> None: ...

    def stop_node(self, node: str) -> None: ...

    def show_newest_error(self, node: str) -> None: ...


class ConsoleBase(ThemedApp):
    """The console as its views and bars see it. `context` and `app` implement it, and import those."""

    hub: Hub
    windows: Layout
    prefix: str
    flags: dict[int, str]
    """Marks in the window list, by window number: `!` for a crash in that window."""
    deadlocks: int
    last_shell: str
    """The shell command equivalent to the last action."""

    @property
    def focused_view(self) -> View | None:
        """The view in the focused pane."""
        raise NotImplementedError

    @property
    def commands(self) -> Commands:
        raise NotImplementedError

    def say(self, text: str, *, bad: bool = False) -> None:
        """Show a message in the bottom line."""
        raise NotImplementedError

    def did(self, shell: str) -> None:
        """Show the shell command equivalent to the action just taken."""
        raise NotImplementedError

    def open_beside(self, content: Content) -> None:
        """Open a view beside the focused pane, or in a new window if there is no room."""
        raise NotImplementedError

    async def leave(self, how: str) -> None:
        """Leave the console. The graph runs on."""
        raise NotImplementedError


class View(Widget):
    """One view. Subclasses set NAME, compose their widgets and update them in `look`.

    Args:
        hub: The source of the data to show.
        content: The content to show: the view's name, its subject and its options.
    """

    NAME: ClassVar[str] = ""
    DOC: ClassVar[str] = ""
    """The description of the view in the list of views."""
    ACTIONS: ClassVar[tuple[Action, ...]] = ()
    """The actions of the view's keys while it is focused; `do_<name>` carries each out."""
    LEAST_WIDTH: ClassVar[int] = 30
    """The narrowest useful width in columns; where a split would leave less, the view opens elsewhere."""
    LEAST_HEIGHT: ClassVar[int] = 8
    """The same in rows."""
    EVERY: ClassVar[float] = 0.5
    """Minimum seconds between two updates."""
    SHOWS_STATES: ClassVar[bool] = False
    """Whether the view shows states of nodes, and is updated early after a change of state."""

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__()
        self.hub = hub
        self.about = content.about
        self.options = dict(content.options)
        self.looked = 0.0
        """The time of the last call of `look`, by the monotonic clock."""
        for action in self.ACTIONS:
            for key in action.keys:
                self._bindings.bind(key, f"act('{action.name}')", action.title, show=False)

    # for subclasses to override

    @property
    def title(self) -> str:
        """The text of the pane's title."""
        return f"{self.NAME} {self.about}".rstrip()

    @property
    def note(self) -> str:
        """The text on the right of the title: a count or a warning."""
        return ""

    def look(self, now: float) -> None:
        """Draw the changes. Called while the view is on screen; must not wait."""

    def restyle(self) -> None:
        """Redraw everything after a change of theme."""

    @property
    def focus_target(self) -> Widget:
        """The widget that has the focus while the pane has: by default, the first focusable one."""
        return next((widget for widget in self.query("*") if widget.focusable), self)

    def focus_inside(self) -> None:
        """Take the focus."""
        self.screen.set_focus(self.focus_target)

    def reopened(self, content: Content) -> None:
        """Handle another request for the content shown, possibly with other options."""

    def closed(self) -> None:
        """Release resources; the view is being removed."""

    @property
    def active(self) -> View:
        """The view whose keys apply while the pane has the focus: possibly a nested one."""
        return self

    def shows(self, content: Content) -> bool:
        """Show content inside this view if it has a place for it; return whether it does."""
        return False

    def interrupt(self) -> bool:
        """Handle Ctrl-C as a shell does; return whether it was for the view."""
        return False

    def offers(self, action: Action) -> bool:
        """Return whether the bottom line should offer an action now."""
        return action.hint

    def chosen(self) -> dict[str, str]:
        """Return the selection in the view, for commands: `{"node": "/turtlesim"}`."""
        return {}

    # for subclasses to use

    @property
    def content(self) -> Content:
        """The content that would open the view again as it is now."""
        return Content(self.NAME, self.about, self.options)

    @property
    def colours(self) -> Colours:
        return colours_of(self)

    @property
    def console(self) -> ConsoleBase:
        """The console that contains the view."""
        app = self.app
        assert isinstance(app, ConsoleBase)
        return app

    def say(self, text: str, *, bad: bool = False) -> None:
        """Show a message in the bottom line."""
        self.console.say(text, bad=bad)

    def look_soon(self) -> None:
        """Update before the regular time, but only once for a burst of events."""
        self.looked = min(self.looked, time.monotonic() - self.EVERY + SOON)

    def did(self, shell: str) -> None:
        """Show the shell command equivalent to the action just taken."""
        self.console.did(shell)

    def open(self, view: str, about: str = "", **options: object) -> None:
        """Open a view in a pane beside this one."""
        self.console.open_beside(Content(view, about, options))

    def work(self, doing: Callable[[], Awaitable[None]], group: str = "") -> None:
        """Run a coroutine function in a worker; show a GraphflowError that it raises.

        Args:
            group: A name; work replaces unfinished work of the same group. Empty for none.
        """

        async def guarded() -> None:
            try:
                await doing()
            except GraphflowError as error:
                self.say(str(error), bad=True)

        run: Callable[[], Awaitable[None]] = guarded
        self.run_worker(run, group=group or "work", exclusive=bool(group), exit_on_error=True)

    def action_act(self, name: str) -> None:
        carry_out(self, name)

    def on_unmount(self) -> None:
        self.closed()
