"""Actions and their goals: status and feedback; goals can be cancelled, and sent by a form."""

from __future__ import annotations

import shlex
import time
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import DataTable, Input, Static

from graphflow.errors import EncodeError, GraphflowError
from graphflow.introspect.messages.echo import flow, plain, truncated
from graphflow.msgs import registry
from graphflow.msgs.base import Action as ActionType
from graphflow.msgs.base import Message
from graphflow.times import ago
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import plain_text
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.widgets.dialogs import Item, Pick
from graphflow.tui.widgets.form import Form, form_for
from graphflow.tui.widgets.table import FIND, ORDER, Cells, TableView

if TYPE_CHECKING:
    from graphflow.msgs.action_msgs.msg import GoalStatusArray

STATES = ("unknown", "accepted", "executing", "canceling", "succeeded", "canceled", "aborted")
_STATE_COLOURS = ("dim", "warn", "accent", "warn", "good", "dim", "bad")
_GLYPHS = ("?", "◌", "◐", "◑", "●", "○", "✖")
GOALS = 500
"""Goals remembered; ended ones are dropped first, the oldest of them first."""
ACTIONS_BOUND = 50
CANCEL_LIMIT = 5.0
FEEDBACK = 2000
"""Maximum characters kept of a goal's feedback."""


@dataclass
class Goal:
    """One goal as published by its action server."""

    action: str
    id: bytes
    state: int
    began: float
    ended: float | None = None
    feedback: str = ""


class Goals(TableView):
    """The goals of one action, or of all."""

    NAME = "goals"
    DOC = "goals: state, feedback, cancel; a form for a new one"
    LEAST_WIDTH = 56
    EMPTY = "no goals yet"
    COLUMNS = ("goal", "action", "state", "for", "feedback")
    EVERY = 0.25
    ACTIONS = (
        Action(
            "new", "new goal", keys=("n", "enter"), verb="graphflow action send_goal {action} TYPE VALUES", hint=True
        ),
        Action("send", "send it", keys=("ctrl+s",), hint=True),
        Action("earlier", "the goal before", keys=("ctrl+up",)),
        Action("later", "the goal after", keys=("ctrl+down",)),
        Action("cancel", "cancel", keys=("c",), hint=True),
        Action("back", "put the form away", keys=("escape",)),
        FIND,
        ORDER,
    )
    DEFAULT_CSS = """
    Goals .shell { height: auto; max-height: 8; padding: 0 1; color: $text-muted; }
    """

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._monitors: dict[str, list[TopicMonitor]] = {}
        self._types: dict[str, str] = {}
        self._goals: dict[str, Goal] = {}
        self._form: Form | None = None
        self._sent_to = ""
        self._shell = Static("", classes="shell", markup=False)

    def compose(self) -> ComposeResult:
        yield from super().compose()
        yield self._shell

    @property
    def title(self) -> str:
        return f"new goal for {self._sent_to}" if self._form is not None else f"goals {self.about}".rstrip()

    @property
    def focus_target(self) -> Widget:
        return self.table if self._form is None else next(iter(self._form.query(Input)), self.table)

    @property
    def note(self) -> str:
        if not self._types:
            return "no action servers"
        running = sum(g.state in (1, 2, 3) for g in self._goals.values())
        return f"{len(self._types)} action{'s' if len(self._types) > 1 else ''}, {running} running"

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None or live.context is None:
            return
        actions = live.cache.actions()
        wanted = [n for n in actions if not self.about or n == self.about][:ACTIONS_BOUND]
        self._types = {name: actions[name][0] for name in wanted if actions[name]}
        for name in wanted:
            if name not in self._monitors:
                status = TopicMonitor(live, f"{name}/_action/status")
                feedback = TopicMonitor(live, f"{name}/_action/feedback")
                status.on_message, feedback.on_message = partial(self._status, name), partial(self._feedback, name)
                self._monitors[name] = [status, feedback]
        for name in [n for n in self._monitors if n not in wanted]:
            for monitor in self._monitors.pop(name):
                monitor.close()
        for monitors in self._monitors.values():
            for monitor in monitors:
                monitor.look()
        super().look(now)
        if self._form is None:
            chosen = self._goals.get(self.key)
            self._shell.update(f"feedback: {chosen.feedback}" if chosen is not None and chosen.feedback else "")

    def _status(self, action: str, message: GoalStatusArray, _: float) -> None:
        now = time.monotonic()
        for status in message.status_list[-GOALS:]:
            raw = bytes(status.goal_info.goal_id.uuid)
            state = status.status if 0 <= status.status < len(STATES) else 0
            goal = self._goals.get(raw.hex())
            if goal is None:
                self._goals[raw.hex()] = goal = Goal(action, raw, state, now)
            goal.state = state
            if state >= 4 and goal.ended is None:
                goal.ended = now
        while len(self._goals) > GOALS:
            old = next((k for k, g in self._goals.items() if g.ended is not None), next(iter(self._goals)))
            del self._goals[old]

    def _feedback(self, action: str, message: Any, _: float) -> None:
        goal = self._goals.get(bytes(message.goal_id.uuid).hex())
        if goal is not None and goal.action == action:
            goal.feedback = plain_text(flow(truncated(plain(message.feedback), 16)))[:FEEDBACK]

    def rows(self) -> dict[str, Cells]:
        colours, now = self.colours, time.monotonic()
        found: dict[str, Cells] = {}
        for key, goal in sorted(self._goals.items(), key=lambda item: (item[1].state >= 4, -item[1].began)):
            span = (goal.ended or now) - goal.began
            found[key] = (
                Text(key[:8], style=colours.dim),
                Text(goal.action),
                Text(f"{_GLYPHS[goal.state]} {STATES[goal.state]}", style=getattr(colours, _STATE_COLOURS[goal.state])),
                Text(ago(span), justify="right"),
                Text(goal.feedback, style=colours.dim),
            )
        for name, type_ in self._types.items():
            if not any(g.action == name for g in self._goals.values()):
                found[name] = (
                    Text(""),
                    Text(name),
                    Text("no goal yet", style=colours.dim),
                    "",
                    Text(f"{type_}  n sends one", style=colours.dim),
                )
        return found

    def chosen(self) -> dict[str, str]:
        goal = self._goals.get(self.key)
        action = goal.action if goal is not None else self.key
        return {"action": action} if action else {}

    # cancelling and sending

    def do_cancel(self) -> None:
        goal = self._goals.get(self.key)
        if goal is None:
            self.say("choose a goal first")
            return
        if goal.state >= 4:
            self.say(f"the goal has ended: {STATES[goal.state]}")
            return

        async def cancel() -> None:
            from graphflow.msgs.action_msgs.msg import GoalInfo
            from graphflow.msgs.action_msgs.srv import CancelGoal
            from graphflow.msgs.unique_identifier_msgs.msg import UUID

            assert self.hub.live is not None
            request = CancelGoal.Request(goal_info=GoalInfo(goal_id=UUID(uuid=list(goal.id))))
            name = f"{goal.action}/_action/cancel_goal"
            answer = await self.hub.live.ask(lambda g: g.call(name, CancelGoal.NAME, request, CANCEL_LIMIT))
            if answer.return_code:
                self.say(f"{goal.action} refuses to cancel the goal, code {answer.return_code}", bad=True)
            else:
                self.say("the goal is being cancelled")

        self.hub.announce(f"cancel a goal of {goal.action}")
        self.work(cancel)

    def on_data_table_row_selected(self, event: DataTable.RowSelected) -> None:
        event.stop()
        self.do_new()

    def do_new(self) -> None:
        if self._form is not None:
            return
        names = list(self._types)
        name = self.chosen().get("action") or (names[0] if len(names) == 1 else "")
        if name in self._types:
            self._open(name)
        elif names:
            items = [Item(n, self._types[n], n) for n in names]
            self.app.push_screen(Pick("A goal for", items), lambda n: self._open(n) if n else None)
        else:
            self.say("no node offers an action")

    def _open(self, name: str) -> None:
        try:
            words = ("action", "send_goal", "-f", name, self._types[name])
            self._form = form_for(f"{self._types[name]}_Goal", self.hub.history.requests(*words))
        except GraphflowError as error:
            self.say(str(error), bad=True)
            return
        self._sent_to = name
        self.mount(self._form, before=self._shell)
        self._show_shell()

    def do_back(self) -> None:
        if self._form is not None:
            self._form.remove()
            self._form = None
            self._shell.update("")
            self.table.focus()
        else:
            self.key_escape()

    def on_form_edited(self) -> None:
        self._show_shell()

    def on_form_completed(self) -> None:
        self.do_send()

    def _command(self) -> str:
        assert self._form is not None
        values = shlex.quote(flow(self._form.values()))
        return f"graphflow action send_goal -f {self._sent_to} {self._types[self._sent_to]} {values}"

    def _show_shell(self) -> None:
        try:
            assert self._form is not None
            self._form.message()
            self._shell.update(f"tab next field, ctrl+s sends, esc back;  $ {self._command()}")
        except EncodeError as error:
            self._shell.update(str(error))

    def do_earlier(self) -> None:
        self._recall(-1)

    def do_later(self) -> None:
        self._recall(1)

    def _recall(self, step: int) -> None:
        if self._form is not None:
            self.say(self._form.recall(step) or f"no goal was sent to {self._sent_to} before")

    def do_send(self) -> None:
        form, live = self._form, self.hub.live
        if form is None or live is None or live.node is None:
            self.do_new()
            return
        name = self._sent_to
        type_: type[ActionType[Message, Message, Message]] = registry.interface_class(self._types[name])
        if fault := form.first_fault():
            self.say(fault, bad=True)
            return
        goal, command = form.message(), self._command()
        self.hub.history.add(command)
        self.did(command)
        self.hub.announce(command.removeprefix("graphflow "))

        async def send() -> None:
            client = live.action_client(type_, name)
            sent = await client.send_goal(goal)
            result = await sent.result()
            self.say(f"{name}: {plain_text(flow(truncated(plain(result), 32)))[:200]}")

        self.work(send)
        self.do_back()

    def closed(self) -> None:
        for monitors in self._monitors.values():
            for monitor in monitors:
                monitor.close()
        self._monitors.clear()


VIEW = Goals
