"""A step of the guided tour: a deadlock in the groups view, with a guide above it."""

from __future__ import annotations

import time

from rich.text import Text
from textual.app import ComposeResult
from textual.widgets import Static

from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.panes import Content
from graphflow.tui.views.groups import Groups


class Tour(Groups):
    """The groups of an example, with a guide.

    Options: `title`, the fault of the example; `step`, such as `3/11 classic`; `seconds` until the fault appears;
    `fixed`, the comment in the graph file if this is the repaired example.
    """

    NAME = "tour"
    DOC = "an example of `graphflow demo`, with what to press next"
    ACTIONS = (Action("go_on", "go on", keys=("n",), hint=True), *Groups.ACTIONS)

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._guide = Static(classes="guide")
        self._began = time.monotonic()

    def compose(self) -> ComposeResult:
        yield self._guide
        yield from super().compose()

    @property
    def title(self) -> str:
        return f"tour {self.options.get('step', '')}".rstrip()

    def look(self, now: float) -> None:
        super().look(now)
        colours = self.colours
        text = Text(f"{self.options.get('title', '')}\n\n", style=colours.strong)
        advice, keys = self._advice()
        text.append(f"{advice}\n", style=colours.text)
        for key, effect in [*keys, ("q", "leave the tour; its graph goes down")]:
            text.append(f"  {key}", style=colours.accent)
            text.append(f"  {effect}\n", style=colours.text)
        self._guide.update(text)

    def _advice(self) -> tuple[str, list[tuple[str, str]]]:
        """Return the description of the situation, and the keys that lead on."""
        is_last = str(self.options.get("step", "")).partition(" ")[0].partition("/")[::2]
        go_on = ("n", "end the tour" if is_last[0] == is_last[1] else "the next example")
        repaired = ("n", "the same graph, repaired in its file")
        fixed = str(self.options.get("fixed", ""))
        if fixed:
            return f"Repaired, and it runs; see the log. Its file now reads:\n{fixed}", [go_on]
        if self._deadlocks and any(self._fixes):
            return "The nodes are stuck. The ring below shows who waits for whom, and in which line.", [
                ("f", f"end it, while the graph runs: {next(found[0].title for found in self._fixes if found)}"),
                ("enter", "open the line of source"),
            ]
        if self._deadlocks:
            return (
                "The nodes are stuck. The ring below shows why, and which change of the code ends it.",
                [
                    ("enter", "open the line of source"),
                    repaired,
                ],
            )
        if self._is_freed and self._changes:
            return "It moves again; see the log. The change lasts until the graph stops.", [
                ("w", "keep it: write it into the graph file"),
                go_on,
            ]
        if self._is_freed:
            return "It moves again, and the graph file keeps it that way.", [go_on]
        if self._applied is not None:
            return "It is being changed ...", []
        if time.monotonic() - self._began < float(self.options.get("seconds", 0.0)) + 2.0:
            return "Everything runs. In a moment it will not: wait.", []
        return "No ring: nothing waits for ever here, things happen in the wrong order. See the log.", [repaired]

    def do_go_on(self) -> None:
        """Leave for the next step."""
        is_done = bool(self.options.get("fixed")) or self._is_freed
        self.console.run_worker(self.console.leave("next" if is_done else "fixed"))


VIEW = Tour
