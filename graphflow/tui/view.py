"""What a pane shows: the base class of all views, those of other packages too.

A view reads from its `hub` when it is looked at, a few times a second, and draws what has changed. It never waits: what
takes time goes through `work`, and its result comes back on the loop.
"""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable
from typing import Any, ClassVar

from textual.widget import Widget

from graphflow.errors import GraphflowError
from graphflow.tui.commands.actions import Action, carry_out
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.widgets.colours import Colours

SOON = 0.1
"""Seconds after an event in which what follows it may come, too, to be drawn with it."""


class View(Widget):
    """One view. Subclasses give it a NAME, compose their widgets and fill them in `look`.

    Args:
        hub: What is shown comes from here.
        content: What was asked for: the view's name, what it is about, its options.
    """

    NAME: ClassVar[str] = ""
    DOC: ClassVar[str] = ""
    """What the view shows, in a line for the list of views."""
    ACTIONS: ClassVar[tuple[Action, ...]] = ()
    """What its keys do while it is focused: `do_<name>` for each."""
    LEAST_WIDTH: ClassVar[int] = 30
    """Columns without which it says little: where a split would leave less, it opens otherwise."""
    EVERY: ClassVar[float] = 0.5
    """Seconds between two looks at most."""
    SHOWS_STATES: ClassVar[bool] = False
    """Whether it shows the states of nodes: then it looks soon after the supervisor has told of one."""

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__()
        self.hub = hub
        self.about = content.about
        self.options = dict(content.options)
        self.looked = 0.0
        """When `look` was called last, by the monotonic clock."""
        for action in self.ACTIONS:
            for key in action.keys:
                self._bindings.bind(key, f"act('{action.name}')", action.title, show=False)

    # for subclasses

    @property
    def title(self) -> str:
        """What the pane's title says."""
        return f"{self.NAME} {self.about}".rstrip()

    @property
    def note(self) -> str:
        """What stands on the right of the title: a count, a warning."""
        return ""

    def look(self, now: float) -> None:
        """Draw what has changed. Called while the view is on screen."""

    def restyle(self) -> None:
        """Draw everything again: the theme has changed."""

    @property
    def heart(self) -> Widget:
        """What has the focus when the pane has: the first widget that can, unless told otherwise."""
        return next((widget for widget in self.query("*") if widget.focusable), self)

    def focus_inside(self) -> None:
        """Take the focus."""
        self.screen.set_focus(self.heart)

    def asked_again(self, content: Content) -> None:
        """Take in that what it shows was asked for once more, perhaps with other options."""

    def closed(self) -> None:
        """The view is going away: let go of what it holds."""

    @property
    def active(self) -> View:
        """The view whose keys count while the pane has the focus: one inside of it, perhaps."""
        return self

    def shows(self, content: Content) -> bool:
        """Show something that was asked for inside of this view; returns whether it is a place for that."""
        return False

    def interrupt(self) -> bool:
        """Take Ctrl-C, as a shell does; returns whether it was for the view."""
        return False

    def offers(self, action: Action) -> bool:
        """Whether the bottom line should show an action now."""
        return action.hint

    def chosen(self) -> dict[str, str]:
        """What is chosen in the view, for commands: `{"node": "/turtlesim"}`."""
        return {}

    # what subclasses use

    @property
    def content(self) -> Content:
        """What would open the view again as it is now."""
        return Content(self.NAME, self.about, self.options)

    @property
    def colours(self) -> Colours:
        colours: Colours = self.app.colours  # type: ignore[attr-defined]
        return colours

    @property
    def console(self) -> Any:
        """The console that the view is in."""
        return self.app

    def say(self, text: str, *, bad: bool = False) -> None:
        """Tell the user something in the bottom line."""
        self.console.say(text, bad=bad)

    def look_soon(self) -> None:
        """Look again before it is due, but not for each of many events."""
        self.looked = min(self.looked, time.monotonic() - self.EVERY + SOON)

    def did(self, shell: str) -> None:
        """Show the shell command that does what was just done."""
        self.console.did(shell)

    def open(self, view: str, about: str = "", **options: Any) -> None:
        """Show something in a pane beside this one."""
        self.console.open_beside(Content(view, about, options))

    def work(self, doing: Callable[[], Awaitable[None]], group: str = "") -> None:
        """Do something that takes time; a GraphflowError that it raises is shown.

        Args:
            group: Work of one group replaces what is still under way in it; empty for none.
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
