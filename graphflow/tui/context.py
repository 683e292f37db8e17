"""The context shared by views, bars and commands: the hub, the windows, and messages to the user."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable

from textual.timer import Timer

from graphflow.tui.commands.actions import shown
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.layout import Layout
from graphflow.tui.pane_area import Workspace
from graphflow.tui.panes import Window
from graphflow.tui.tty import clipboard
from graphflow.tui.tty.job_control import JobControl
from graphflow.tui.view import ConsoleBase, View
from graphflow.tui.widgets.bars import Hints, Status
from graphflow.tui.widgets.welcome import Welcome

MESSAGES = 500
"""Messages remembered."""
SAVE_AFTER = 1.0
"""Seconds after the last change of the windows at which they are saved with the run."""
LASTING = "lasting"
"""The worker group whose workers run until the console is left."""
LEAVE_WITHIN = 2.0
"""Seconds to wait for the panes' workers to end."""


class ConsoleApp(ConsoleBase):
    """The console as its views, bars and commands see it."""

    hints: Hints
    status: Status
    welcome: Welcome
    workspace: Workspace
    job_control: JobControl

    def __init__(self, hub: Hub, windows: Layout, prefix: str) -> None:
        super().__init__()
        self.hub = hub
        self.windows = windows
        self.prefix = prefix
        self.flags: dict[int, str] = {}
        self.deadlocks = 0
        self.clipboard_text = ""
        self.last_shell = ""
        self.messages: list[str] = []
        """The messages shown so far, oldest first."""
        self._save_timer: Timer | None = None

    def spawn(self, work: Callable[[], Awaitable[None]]) -> None:
        """Run a coroutine function until the console is left."""
        self.run_worker(work, group=LASTING)

    async def leave(self, how: str) -> None:
        if self.hub.supervision is not None:
            self.save_layout()
        views = [frame.view for frame in self.workspace.frames.values()]
        for view in views:
            view.closed()
        # Workers of views use the graph, so they end before it is left.
        under_way = [worker for view in views for worker in self.workers.cancel_node(view)]
        ends = asyncio.gather(*(w.wait() for w in under_way), return_exceptions=True)
        await asyncio.wait([ends], timeout=LEAVE_WITHIN)
        if self.hub.live is not None:
            await self.hub.live.close()
        if self.hub.supervision is not None:
            await self.hub.supervision.leave()
        # Last, as one of these follows the supervisor, and `leave` above waits for it.
        self.workers.cancel_group(self, LASTING)
        self.exit(how)

    @property
    def focused_view(self) -> View | None:
        frame = self.workspace.focused
        return None if frame is None else frame.view.active

    def say(self, text: str, *, bad: bool = False) -> None:
        self._log_message(text)
        self.hints.say(text, "bad" if bad else "text")

    def _log_message(self, text: str) -> None:
        self.messages.append(f"{time.strftime('%H:%M:%S')}  {text}")
        del self.messages[:-MESSAGES]

    def did(self, shell: str) -> None:
        self.last_shell = shell
        self._log_message(f"$ {shell}")
        self.hints.say(f"$ {shell}   ({shown(self.prefix)} y copies)", "accent")

    def changed(self) -> None:
        """Redraw after a change of the windows, and save them with the run soon."""
        self.workspace.sync()
        self.status.refresh()
        self.hints.refresh()
        if self._save_timer is not None:
            self._save_timer.stop()
        self._save_timer = self.set_timer(SAVE_AFTER, self.save_layout)

    def save_layout(self) -> None:
        """Save the windows with the run, so that the next console to attach restores them."""
        self.workspace.store_contents()
        if self.hub.supervision is not None:
            self.hub.supervision.send(do="keep_layout", layout=self.windows.to_json())

    @property
    def window(self) -> Window:
        return self.windows.window

    def copy(self, text: str, what: str = "") -> None:
        self.clipboard_text = text
        self.copy_to_clipboard(text)
        words = clipboard.program()
        if not words:
            self.say(
                f"copied {what or text}, if the terminal lets programs copy; {shown(self.prefix)} ] pastes it here"
            )
            return

        async def copy() -> None:
            trouble = await asyncio.to_thread(clipboard.copy_with, words, text)
            self.say(f"not copied: {trouble}" if trouble else f"copied {what or text}", bad=bool(trouble))

        self.spawn(copy)
