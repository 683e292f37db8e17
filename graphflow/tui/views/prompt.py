"""A prompt for verbs of graphflow, each run in a process of its own, whose output streams into the pane."""

from __future__ import annotations

import asyncio
import os
import shlex
import signal
from collections import deque

from rich.text import Text
from textual import events
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import Input

from graphflow.tui.commands.actions import Action, shown
from graphflow.tui.commands.completion import Completer, completed, nothing_to_complete
from graphflow.tui.commands.history import without_program
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import plain_text
from graphflow.tui.panes import Content
from graphflow.tui.view import View
from graphflow.tui.widgets.line_view import LineView

CHUNK = 1 << 16
WAITING = 2_000
"""Maximum lines waiting to be drawn; further ones are counted and dropped."""
WELCOME = (
    "Any verb of graphflow: topic echo /turtle1/pose, param set ..., action send_goal ...",
    "tab completes, ↑ recalls, ^c ends the command; f2 shows a view here instead.",
)


class Prompt(View):
    """A command line, and the output of its commands."""

    NAME = "prompt"
    DOC = "type any graphflow verb; its output streams here"
    LEAST_WIDTH = 48
    EVERY = 0.1
    ACTIONS = (
        Action("complete", "complete", keys=("tab",), hint=True),
        Action("interrupt_it", "interrupt the command", keys=("ctrl+c",), hint=True),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._lines = LineView[str | Text](10_000, wraps=True, copies=True)
        self._input = Input(placeholder="a command, such as: topic list", classes="line")
        self._completer = Completer(hub)
        self._runs_at_once = bool(self.options.pop("run", False))
        self._process: asyncio.subprocess.Process | None = None
        self._fresh: deque[tuple[str, str]] = deque()
        self._lost = 0
        self._at = 0
        self._was_interrupted = False
        """Whether the current or last command was interrupted."""
        self._offered: list[str] = []
        """The completions shown last."""

    def compose(self) -> ComposeResult:
        yield self._lines
        yield self._input

    def on_mount(self) -> None:
        self._at = len(self.hub.history.lines)
        if self.about and self._runs_at_once:
            self._run(self.about, at_once=True)
        elif self.about:  # restored with the windows: not run again, since it may have effects
            self._input.value = self.about
            self._lines.extend([Text("enter runs this again", style=self.colours.dim)])
        else:
            self._lines.extend(Text(line, style=self.colours.dim) for line in WELCOME)

    @property
    def title(self) -> str:
        return f"$ {self.about}" if self.about else "prompt"

    @property
    def note(self) -> str:
        dropped = f"{self._lost} lines left out " if self._lost else ""
        return dropped + ("running, ^c ends it" if self._process is not None else "")

    @property
    def focus_target(self) -> Widget:
        return self._input

    def look(self, now: float) -> None:
        if not self._fresh:
            return
        colours = self.colours
        rows = [Text(text, style=getattr(colours, style)) for text, style in self._fresh]
        self._fresh.clear()
        self._lines.extend(rows)

    # the command line

    def on_input_submitted(self, event: Input.Submitted) -> None:
        event.stop()
        text = event.value.strip()
        self._input.value = ""
        if not text:
            return
        self.hub.history.add(text)
        self._at = len(self.hub.history.lines)
        if text in ("clear", "exit", "quit"):
            self._lines.replace([]) if text == "clear" else self.console.commands.do_close_pane()
            return
        self._run(text)

    def on_input_changed(self, event: Input.Changed) -> None:
        if event.value == ":":  # opens the command line, as in other views: no verb begins with it
            self._input.value = ""
            self.console.commands.do_command()

    def on_key(self, event: events.Key) -> None:
        if event.key in ("up", "down") and self._input.has_focus:
            event.stop()
            past = self.hub.history.lines
            self._at = max(0, min(len(past), self._at + (1 if event.key == "down" else -1)))
            self._input.value = past[self._at] if self._at < len(past) else ""
            self._input.cursor_position = len(self._input.value)

    def do_complete(self) -> None:
        """Complete the command; show the candidates if there are several."""
        self.work(self._complete, group="complete")

    async def _complete(self) -> None:
        text, choices = await completed(self._input, self._completer)
        if not choices:
            self.say(nothing_to_complete(text))
        if len(choices) > 1 and choices != self._offered:
            self._offered = choices
            shown = "  ".join(choices[:60]) + (f"  ... {len(choices)} in all" if len(choices) > 60 else "")
            self._lines.extend([Text(shown, style=self.colours.dim)])

    # the process

    def _run(self, text: str, *, at_once: bool = False) -> None:
        self._runs_at_once = at_once
        if self._process is not None:
            self.say("a command is running here; ^c ends it, or open another pane", bad=True)
            return
        text = without_program(text)
        self.about = text
        self.work(lambda: self._stream(text))

    async def _stream(self, text: str) -> None:
        self._was_interrupted = False
        self._lines.action_bottom()
        self._lines.extend([Text(f"$ graphflow {text}", style=self.colours.accent)])
        self._lost = 0
        try:
            words = shlex.split(text)
        except ValueError as error:
            self._lines.extend([Text(f"{error}: check the quotes", style=self.colours.bad)])
            return
        refusal = _refusal(words, shown(self.console.prefix))
        if refusal:
            self._lines.extend([Text(refusal, style=self.colours.warn)])
            return
        self.console.did(f"graphflow {text}")
        env = {**os.environ, "GRAPHFLOW_ENDS_WITH": str(os.getpid()), "COLUMNS": str(max(40, self.size.width - 1))}
        process = self._process = await asyncio.create_subprocess_exec(
            *self.hub.command,
            *words,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            env=env,
            start_new_session=True,
        )
        assert process.stdout is not None
        assert process.stderr is not None
        try:
            await asyncio.gather(self._read(process.stdout, "text"), self._read(process.stderr, "warn"))
            code = await process.wait()
            if code:
                self._fresh.append((f"exit code {code}", "bad"))
            if self._runs_at_once and not self._was_interrupted:  # to be read from the top
                self.look(0.0)
                self._lines.hold()
                self._lines.scroll_home(animate=False, immediate=True)
        finally:
            if process.returncode is None:
                process.kill()
                await process.communicate()  # reaps it, and closes its pipes
            self._process = None

    async def _read(self, stream: asyncio.StreamReader, style: str) -> None:
        rest = b""
        while data := await stream.read(CHUNK):
            *lines, rest = (rest + data).split(b"\n")
            if len(rest) > CHUNK:
                lines, rest = [*lines, rest], b""
            for line in lines:
                if len(self._fresh) >= WAITING:
                    self._fresh.popleft()
                    self._lost += 1
                self._fresh.append((plain_text(line.decode(errors="replace")), style))
            await asyncio.sleep(0)
        if rest:
            self._fresh.append((plain_text(rest.decode(errors="replace")), style))

    def interrupt(self) -> bool:
        """Interrupt the command, or clear the line; as in a shell, Ctrl-C does no more than that."""
        if self._process is None or self._process.returncode is not None:
            self._input.value = ""
            self.say(f"nothing runs here any more; {shown(self.console.prefix)} S asks to stop the graph")
        else:
            self._was_interrupted = True
            self._process.send_signal(signal.SIGINT)
        return True

    def do_interrupt_it(self) -> None:
        self.interrupt()

    def closed(self) -> None:
        if self._process is not None and self._process.returncode is None:
            self._process.terminate()


def _refusal(words: list[str], prefix: str) -> str:
    """Return why a verb cannot run in a pane; empty if it can.

    Args:
        prefix: The prefix key as displayed.
    """
    first = words[0] if words else ""
    if first in ("attach", "console"):
        return f"this is a console already; {prefix} s switches to another graph"
    if first == "up" and "-d" not in words and "--detach" not in words:
        return f"in a pane a graph runs in the background: graphflow up -d ..., then {prefix} s switches to it"
    return ""


VIEW = Prompt
