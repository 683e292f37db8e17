"""The console application: its screen, its keys, and the timer that updates the visible views."""

from __future__ import annotations

import time
from typing import Any, ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.screen import Screen

from graphflow.supervisor.rundir import running
from graphflow.tui.commands.actions import console_actions, shown
from graphflow.tui.commands.console_commands import ConsoleCommands
from graphflow.tui.context import ConsoleApp
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.supervision import Event
from graphflow.tui.home import open_home
from graphflow.tui.layout import Layout
from graphflow.tui.pane_area import Workspace
from graphflow.tui.panes import Content
from graphflow.tui.registry import view_class
from graphflow.tui.tty.job_control import JobControl
from graphflow.tui.tty.keyboard import Keyboard, Typed
from graphflow.tui.tty.pacing import Pacing
from graphflow.tui.view import View
from graphflow.tui.widgets.bars import Hints, Status
from graphflow.tui.widgets.colours import DARK, LIGHT, make_colours, recolouring
from graphflow.tui.widgets.line_view import LineView
from graphflow.tui.widgets.welcome import Welcome

PULSE = 0.05
"""Seconds between two updates: nothing is drawn more than twenty times a second."""


class MainScreen(Screen[object], inherit_bindings=False):
    """The screen of the panes. Tab and Ctrl-C go to the panes, not to Textual."""

    AUTO_FOCUS = ""  # the workspace moves the focus itself


class Console(ConsoleApp):
    """The console. Its result is how it was left: `detach`, `stop`, `switch SOCKET`, or a result of the tour.

    Args:
        hub: The sources of data.
        layout: The initial windows; None for the default ones.
        prefix: The prefix key.
        theme: The name of a theme.
        welcome: Whether to show the line for newcomers.
    """

    CSS_PATH = "app.tcss"
    ENABLE_COMMAND_PALETTE = False
    BINDINGS: ClassVar[list[BindingType]] = [
        # With priority a key is the console's even while an input has the focus, which takes the others as text.
        Binding(",".join(action.keys), f"do('{action.name}')", action.title, show=False, priority="ctrl+" in key)
        for action in console_actions()
        for key in action.keys[:1]
    ]

    def __init__(
        self,
        hub: Hub,
        layout: Layout | None = None,
        prefix: str = "ctrl+b",
        theme: str = DARK.name,
        *,
        welcome: bool = False,
    ) -> None:
        super().__init__(hub, layout or Layout(), prefix)
        if not self.windows.windows:
            open_home(self.windows, hub)
        self.workspace = Workspace(self.windows, self._make_view)
        self._commands = ConsoleCommands(self)
        self.hints = Hints()
        self.status = Status()
        self.keyboard = Keyboard(self, super().on_event, self._commands.do)
        self.welcome = Welcome()
        self.welcome.display = welcome
        self.job_control = JobControl(self, self.hints.refresh)
        self.pacing = Pacing()
        self._beats = 0
        self._stopped_for = ""
        """The reason for which the graph is being stopped."""
        self.register_theme(DARK)
        self.register_theme(LIGHT)
        self.theme = theme if theme in self.available_themes else DARK.name
        self.colours = make_colours(self)

    # life

    def compose(self) -> ComposeResult:
        yield self.workspace
        yield self.welcome
        yield self.hints
        yield self.status
        yield self.keyboard.which_key

    def get_default_screen(self) -> Screen[object]:
        return MainScreen(id="_default")

    def on_mount(self) -> None:
        self.job_control.handle_signals()
        self.theme_changed_signal.subscribe(self, lambda _: self._new_colours())
        self.set_interval(PULSE, self._pulse)
        self.call_after_refresh(self._begin)

    def _begin(self) -> None:
        """Start the slow parts, now that the first screen has been drawn."""
        others = len(running()) - 1 if self.hub.supervision is not None else 0
        if others > 0:
            self.say(f"{others} more running; {shown(self.prefix)} s goes to another graph")
        if self.hub.supervision is not None:
            self.spawn(self.hub.supervision.follow)
        if self.hub.live is None:
            self.spawn(self._join)

    async def _join(self) -> None:
        from graphflow.tui.feeds.graph_feed import Live

        live = Live(self.hub.domain)
        await live.open()
        self.hub.live = live
        if live.trouble:
            self.say(live.trouble, bad=True)

    # events of the supervisor

    def on_descendant_focus(self) -> None:
        self.hints.refresh()

    def handle_supervisor_event(self, event: Event) -> None:
        """Handle an event of the supervisor."""
        match event["event"]:
            case "ps":
                self.hub.logs.follow(self.hub.log_files())
            case "stopping":
                self._stopped_for = str(event["reason"])
            case "exited" if event["unexpected"]:
                self.flags[self.windows.current] = "!"
        if notice := self._notice_of(event):
            self.say(notice)
        elif failure := self._failure_of(event):
            self.say(failure, bad=True)
        for frame in self.workspace.visible_frames:
            if frame.view.SHOWS_STATES:
                frame.view.look_soon()
        self.status.refresh()

    def _notice_of(self, event: Event) -> str:
        """Return the message for an event that is no failure; empty for none."""
        supervision = self.hub.supervision
        match event["event"]:
            case "hello" if supervision is not None:
                return supervision.version_note
            case "announced" if supervision is not None and event["by"] != supervision.name:
                return f"{event['text']} by {event['by']}"
            case "stopping":
                return f"stopping ({event['reason']})"
            case "note" | "said":
                return str(event["text"])
            case "end" if not event["exit_code"]:
                return self._end_of(event)
        return ""

    def _failure_of(self, event: Event) -> str:
        """Return the message for an event that is a failure; empty for none."""
        supervision = self.hub.supervision
        match event["event"]:
            case "step" if not event["ok"]:
                return f"step {event['step']} FAILED: {event['text']}"
            case "error":
                return str(event["message"])
            case "exited" if event["unexpected"]:
                again = event.get("again")
                restart = "" if again is None else f"; it is started again in {again:.1f} s"
                nodes = ", ".join(event["nodes"])
                return f"{shown(self.prefix)} e shows why: {nodes} died, {event['how']}{restart}"
            case "end" if event["exit_code"]:
                return self._end_of(event)
            case "lost" if supervision is not None and supervision.exit_code is None:
                return f"{event['message']}; q leaves"
        return ""

    def _end_of(self, event: Event) -> str:
        why = f" ({self._stopped_for})" if self._stopped_for else ""
        return f"the graph has ended{why}, exit code {event['exit_code']}; q leaves"

    # updates

    def _display(self, screen: Screen[Any], renderable: Any) -> None:
        # Textual calls this for each composed frame, and has no public hook between composing and writing.
        if self.is_headless or self.pacing.admits(self._driver):
            super()._display(screen, renderable)

    async def _pulse(self) -> None:
        now = time.monotonic()
        if self.pacing.catches_up(self._driver):
            self.screen.refresh(layout=True)
        await self.keyboard.look(now)
        self._beats += 1
        if self._beats % 2 == 0:
            self.hub.logs.read()
        # Behind a dialog, panes are updated only twice a second.
        if self.screen is self.screen_stack[0] or self._beats % 10 == 0:
            for frame in self.workspace.visible_frames:
                view = frame.view
                # Half a pulse less: the timer is not exact, and a view that is nearly due would wait for another one.
                if view.is_mounted and now - view.looked >= view.EVERY - PULSE / 2:
                    view.looked = now
                    view.look(now)
                if self._beats % 5 == 0:
                    frame.title_line.refresh_if_changed()
        if self._beats % 10 == 0:
            self.commands.look(now)
            self.hints.look(now)
            self.status.refresh()

    def _make_view(self, content: Content) -> View:
        return view_class(content.view)(self.hub, content)

    def _new_colours(self) -> None:
        old, self.colours = self.colours, make_colours(self)
        recolour = recolouring(old, self.colours)
        for frame in self.workspace.frames.values():
            if frame.view.is_mounted:
                frame.view.restyle()
                for lines in frame.view.query(LineView):
                    lines.recolour(recolour)
        self.refresh(layout=True)

    @property
    def commands(self) -> ConsoleCommands:
        return self._commands

    def open_beside(self, content: Content) -> None:
        self.commands.open_beside(content)

    # keys

    async def on_event(self, event: events.Event) -> None:
        if isinstance(event, Typed) and not event.is_forwarded:
            # A terminal that sends keys has the focus, whatever it reported: tmux does not report focus that returns.
            # Textual focuses nothing in a dialog that opens while the terminal is out of focus.
            self.app_focus = True
            await self.keyboard.type(event)
        else:
            await super().on_event(event)

    async def on_workspace_focus_arrived(self) -> None:
        await self.keyboard.go_on()

    def on_line_view_search_requested(self, event: LineView.SearchRequested) -> None:
        self.commands.search_in(event.lines)

    async def on_keyboard_marker(self, event: Keyboard.Marker) -> None:
        await self.keyboard.marker_arrived(event)

    def action_do(self, name: str) -> None:
        self.commands.do(name)

    def watch_app_focus(self, focus: bool) -> None:
        """Focus a dialog that opened while the terminal was out of focus."""
        if focus and len(self.screen_stack) > 1 and self.screen.focused is None:
            self.screen.focus_next()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Restrict the console's unprefixed keys to its own screen; dialogs above it do not get them."""
        if action == "do" and len(self.screen_stack) > 1:
            return parameters[:1] == ("interrupt",)
        return True
