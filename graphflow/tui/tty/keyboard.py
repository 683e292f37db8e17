"""The queue of typed keys: handled strictly one after the other, with the prefix and its followers taken out.

Textual posts a letter directly to the focused widget, but a bound key by way of the app. Of `topics`, enter, `0` typed
at once, the `0` would overtake the enter. Therefore a key is passed on only when the one before has taken full effect:
a marker message travels its route twice, and so arrives behind everything that the key has caused.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Awaitable, Callable

from textual import events
from textual.message import Message
from textual.timer import Timer
from textual.widget import Widget

from graphflow.tui.commands.actions import OPTION_KEYS, by_chord, shown
from graphflow.tui.context import ConsoleApp
from graphflow.tui.widgets.bars import WhichKey

WHICH_KEY_AFTER = 0.4
"""Seconds after the prefix at which the possible next keys are shown."""
ROUNDS = 2
"""Rounds of the marker: the first arrives behind the key itself, the second behind the effects of the key."""
DONE_AFTER = 2.0
"""Seconds after which a key counts as done although its marker has not come back: its widget is busy with something."""
QUEUE_BOUND = 10_000
"""Maximum number of queued keys; beyond it, the oldest are dropped."""

Typed = events.Key | events.Paste


class Keyboard:
    """Passes keys on in their order.

    Args:
        console: The console that receives the keys.
        pass_on: Passes a key to the focused widget.
        do: Carries out the action of a key after the prefix.
    """

    class Marker(Message):
        """A marker posted behind a key, to arrive once the key has taken effect."""

        def __init__(self, number: int, rounds: int) -> None:
            super().__init__()
            self.number, self.rounds = number, rounds

    def __init__(
        self,
        console: ConsoleApp,
        pass_on: Callable[[events.Event], Awaitable[None]],
        do: Callable[[str], None],
    ) -> None:
        self.which_key = WhichKey()
        self._console, self._pass_on, self._do = console, pass_on, do
        self._chords = by_chord()
        self._chord_open = False
        self._which_timer: Timer | None = None
        self._queue: deque[Typed] = deque(maxlen=QUEUE_BOUND)
        self._number = 0
        self._under_way_since: float | None = None
        self._marked: Widget | None = None
        """The widget or screen to which the marker was posted."""

    @property
    def is_quiet(self) -> bool:
        """Whether all keys have taken effect."""
        return not self._queue and self._under_way_since is None

    async def type(self, event: Typed) -> None:
        """Enqueue a key."""
        self._queue.append(event)
        await self.go_on()

    async def go_on(self) -> None:
        """Pass the next key on, unless one is under way or its pane is still to be focused."""
        console = self._console
        while self._queue and self._under_way_since is None:
            is_for_panes = len(console.screen_stack) == 1
            if is_for_panes and (console.workspace.focus_is_due or self._restores_focus()):
                return
            event = self._queue.popleft()
            self._number += 1
            self._under_way_since = time.monotonic()
            self._marked = None
            if not (isinstance(event, events.Key) and self._takes_as_chord(event)):
                await self._pass_on(event)
            self._post_marker(ROUNDS)

    async def marker_arrived(self, event: Marker) -> None:
        """Handle the arrival of a marker."""
        if event.number != self._number or self._under_way_since is None:
            return
        if event.rounds > 1:
            self._post_marker(event.rounds - 1)
            return
        self._under_way_since = None
        await self.go_on()

    async def look(self, now: float) -> None:
        """Stop waiting for a marker that was removed together with its widget, or that is held up by it."""
        since = self._under_way_since
        if since is not None and (now - since > DONE_AFTER or self._is_marker_lost()):
            self._under_way_since = None
        await self.go_on()

    def _restores_focus(self) -> bool:
        """Restore the pane's focus after the focused widget was hidden; return whether that is possible."""
        return self._console.focused is None and self._console.workspace.regain_focus()

    def _post_marker(self, rounds: int) -> None:
        console = self._console
        self._marked = console.focused or console.screen
        self._marked.post_message(self.Marker(self._number, rounds))

    def _is_marker_lost(self) -> bool:
        marked = self._marked
        if marked is None:  # not posted yet
            return False
        return not marked.is_attached or marked.screen not in self._console.screen_stack

    # the prefix

    def _takes_as_chord(self, event: events.Key) -> bool:
        """Handle a key that is the prefix or follows it; return whether it is one."""
        console = self._console
        console.hints.look(time.monotonic(), pressed=True)
        if self._chord_open:
            self._close_chord()
            if event.key == console.prefix:
                return False  # typed twice: meant for the focused widget
            action = self._chords.get(OPTION_KEYS.get(event.key, event.key))
            prefix, key = shown(console.prefix), shown(event.key)
            if action is not None:
                self._do(action.name)
            elif event.key != "escape":
                console.say(f"{prefix} {key} is not bound; {prefix} ? lists all keys")
            return True
        if event.key == console.prefix and len(console.screen_stack) == 1:
            self._chord_open = True
            self._which_timer = console.set_timer(WHICH_KEY_AFTER, self.which_key.open)
            return True
        return False

    def _close_chord(self) -> None:
        self._chord_open = False
        if self._which_timer is not None:
            self._which_timer.stop()
        self.which_key.display = False
