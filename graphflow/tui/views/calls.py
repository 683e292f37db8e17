"""Services, with a form for calls, the responses, and earlier requests."""

from __future__ import annotations

import shlex
import time

from rich.text import Text
from textual.app import ComposeResult
from textual.widget import Widget
from textual.widgets import DataTable, Input, Static

from graphflow.errors import EncodeError, GraphflowError
from graphflow.introspect.messages.echo import block, flow, plain, truncated
from graphflow.msgs import registry
from graphflow.names import is_hidden
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import plain_text
from graphflow.tui.panes import Content
from graphflow.tui.widgets.form import Form, form_for
from graphflow.tui.widgets.line_view import LineView
from graphflow.tui.widgets.table import FIND, ORDER, Cells, TableView
from graphflow.wire.liveliness import Kind

CALL_LIMIT = 10.0
"""Seconds that a service has to respond."""
_OF_EVERY_NODE = (
    "/describe_parameters",
    "/get_parameter_types",
    "/get_parameters",
    "/list_parameters",
    "/set_parameters",
    "/set_parameters_atomically",
    "/get_logger_levels",
    "/set_logger_levels",
    "/get_type_description",
)


class Calls(TableView):
    """Services, and calls to them."""

    NAME = "calls"
    DOC = "services: a form for the request, the answers so far"
    LEAST_WIDTH = 56
    EMPTY = "no node offers a service of its own; a shows those that every node has"
    COLUMNS = ("service", "type", "node")
    EVERY = 1.0
    ACTIONS = (
        Action("open_form", "fill in and call", keys=("enter",), hint=True),
        Action("send", "call", keys=("ctrl+s",), verb="graphflow service call {service} TYPE VALUES", hint=True),
        Action("earlier", "the request before", keys=("ctrl+up",)),
        Action("later", "the request after", keys=("ctrl+down",)),
        Action("back", "back to the list", keys=("escape",), hint=True),
        Action("hidden", "every node's own services too", keys=("a",)),
        FIND,
        ORDER,
    )
    DEFAULT_CSS = """
    Calls .shell { height: auto; max-height: 3; padding: 0 1; color: $text-muted; }
    """

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._hidden_too = False
        self._type = ""
        self._form: Form | None = None
        self._shell = Static("", classes="shell", markup=False)
        self._answers = LineView[Text](2000, wraps=True, copies=True)

    def compose(self) -> ComposeResult:
        yield from super().compose()
        yield self._shell
        yield self._answers

    def on_mount(self) -> None:
        self._show_list()

    @property
    def title(self) -> str:
        return f"call {self.about}" if self._form is not None else "services"

    def rows(self) -> dict[str, Cells]:
        live, colours = self.hub.live, self.colours
        if live is None:
            return {}
        found: dict[str, Cells] = {}
        for e in live.cache.endpoints(Kind.SERVICE):
            if not self._hidden_too and (is_hidden(e.name) or e.name.endswith(_OF_EVERY_NODE)):
                continue
            found[e.name] = (
                Text(e.name),
                Text(e.type, style=colours.dim),
                Text(e.node_name, style=colours.node(e.node_name)),
            )
        return found

    def look(self, now: float) -> None:
        super().look(now)
        if self.about and self._form is None and self.about in {*self._all()}:
            self._open(self.about)

    def _all(self) -> list[str]:
        return [] if self.hub.live is None else [e.name for e in self.hub.live.cache.endpoints(Kind.SERVICE)]

    @property
    def focus_target(self) -> Widget:
        if self._form is None:
            return self.table
        return next(iter(self._form.query(Input)), self._answers)

    def _show_list(self) -> None:
        has_form = self._form is not None
        self.table.display = not has_form
        self._shell.display = self._answers.display = has_form

    def on_data_table_row_selected(self, event: DataTable.RowSelected) -> None:
        event.stop()
        self.do_open_form()

    def do_open_form(self) -> None:
        if self._form is not None:  # an empty request has no input to focus
            self.do_send()
        elif self.key:
            self._open(self.key)

    def _open(self, name: str) -> None:
        assert self.hub.live is not None
        types = [e.type for e in self.hub.live.cache.endpoints(Kind.SERVICE, name)]
        if not types:
            return
        self.about, self._type = name, types[0]
        try:
            request = registry.service_schema(self._type).request.name
            self._form = form_for(request, self.hub.history.requests("service", "call", name, self._type))
        except GraphflowError as error:
            self.about = ""
            self.say(str(error), bad=True)
            return
        self._answers.replace([])
        self.mount(self._form, before=self._shell)
        self._show_list()
        self._show_shell()

    def do_back(self) -> None:
        if self._form is not None:
            self._form.remove()
            self._form, self.about = None, ""
            self._show_list()
            self.table.focus()
        else:
            self.key_escape()

    def on_form_edited(self) -> None:
        self._show_shell()

    def on_form_completed(self) -> None:
        self.do_send()

    def _command(self) -> str:
        assert self._form is not None
        values = self._form.values()
        return f"graphflow service call {self.about} {self._type}" + (f" {shlex.quote(flow(values))}" if values else "")

    def _show_shell(self) -> None:
        try:
            assert self._form is not None
            self._form.message()
            self._shell.update(f"tab next field, ctrl+s calls, esc back;  $ {self._command()}")
        except EncodeError as error:
            self._shell.update(str(error))

    def do_send(self) -> None:
        form = self._form
        if form is None:
            self.do_open_form()
            return
        if fault := form.first_fault():
            self.say(fault, bad=True)
            return
        message, values, command = form.message(), form.values(), self._command()
        form.keep()
        self.hub.history.add(command)
        name, type_name = self.about, self._type
        self.did(command)
        self.hub.announce(command.removeprefix("graphflow "))

        async def call() -> None:
            assert self.hub.live is not None
            began = time.monotonic()
            colours = self.colours
            self._answers.extend([Text(f"▶ {flow(values)}", style=colours.accent)])
            try:
                answer = await self.hub.live.ask(lambda g: g.call(name, type_name, message, CALL_LIMIT))
            except GraphflowError as error:
                self._answers.extend(Text(plain_text(line), style=colours.bad) for line in str(error).split("\n"))
                return
            lines = block(truncated(plain(answer))).split("\n")
            took = f"◀ after {(time.monotonic() - began) * 1000:.0f} ms"
            self._answers.extend(
                [
                    Text(took, style=colours.good),
                    *(Text(f"  {plain_text(line)}", style=colours.text) for line in lines[:500]),
                ]
            )

        self.work(call)

    def do_earlier(self) -> None:
        self._recall(-1)

    def do_later(self) -> None:
        self._recall(1)

    def _recall(self, step: int) -> None:
        if self._form is not None:
            self.say(self._form.recall(step) or f"no request to {self.about} was made before")

    def do_hidden(self) -> None:
        self._hidden_too = not self._hidden_too
        self.look(0.0)


VIEW = Calls
