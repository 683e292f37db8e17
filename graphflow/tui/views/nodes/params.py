"""The parameters of nodes: values, limits and origins, edited in place."""

from __future__ import annotations

import shlex
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from rich.text import Text
from textual.app import ComposeResult
from textual.widgets import Input

from graphflow.errors import CallError, GraphflowError, ParameterError
from graphflow.interface import TYPE_NAMES, type_id
from graphflow.introspect.graph_view import View as Graph
from graphflow.introspect.messages.echo import flow
from graphflow.introspect.parameters import RemoteParameters, read_value
from graphflow.runtime.parameters.values import from_message, to_message
from graphflow.tui.commands.actions import Action
from graphflow.tui.feeds.hub import Hub
from graphflow.tui.feeds.log_feed import plain_text
from graphflow.tui.feeds.topic_monitor import TopicMonitor
from graphflow.tui.panes import Content
from graphflow.tui.widgets.table import FIND, Cells, TableView
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from graphflow.msgs.rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, ParameterEvent

REPLY_TIMEOUT = 2.0
"""Seconds that a node has to reply."""
NODES = 100
"""Maximum nodes whose parameters are shown at once."""


class Row(NamedTuple):
    """One parameter of one node."""

    node: str
    name: str
    value: object
    type: int
    limits: str
    doc: str
    read_only: bool


class Params(TableView):
    """The parameters of one node, or of all."""

    NAME = "params"
    DOC = "parameters: value, range, source; changed in place"
    LEAST_WIDTH = 56
    EMPTY = "no node here has parameters"
    COLUMNS = ("parameter", "value", "from", "range", "type", "what it is")
    SHED = ("parameter", "value", "range", "from", "what it is", "type")
    KEEPS = 2
    STRETCHES = True
    EVERY = 0.5
    ACTIONS = (
        Action("change", "change", keys=("enter", "e"), verb="graphflow param set {node} {parameter} VALUE", hint=True),
        Action("undo", "undo", keys=("u",), hint=True),
        Action("save", "save to the graph file", keys=("ctrl+s",), hint=True),
        Action("reload", "read again", keys=("R",)),
        FIND,
        Action("copy", "copy the value", keys=("y",)),
    )

    def __init__(self, hub: Hub, content: Content) -> None:
        super().__init__(hub, content)
        self._rows: dict[str, Row] = {}
        self._changed: set[tuple[str, str]] = set()
        """Nodes and names of parameters changed while the view is open."""
        self._before: list[tuple[Row, object]] = []
        """Parameters set here, with their previous values."""
        self._edited = ""
        self._input = Input(classes="find")
        self._events: TopicMonitor | None = None
        self._counted = 0
        self._stale = True
        self._of: list[str] = []
        self._trouble = ""
        """The error of the last request to a node."""
        self._is_reading = True

    def compose(self) -> ComposeResult:
        yield from super().compose()
        yield self._input

    @property
    def title(self) -> str:
        return f"params {self.about or 'of all nodes'}"

    @property
    def note(self) -> str:
        return self._trouble[:60] if self._trouble and self._rows else super().note

    def why_empty(self) -> str:
        return "reading..." if self._is_reading else self._trouble or super().why_empty()

    def chosen(self) -> dict[str, str]:
        row = self._rows.get(self.key)
        return {"node": row.node, "parameter": row.name} if row is not None else {}

    def look(self, now: float) -> None:
        live = self.hub.live
        if live is None or live.context is None:
            return
        if self._events is None:
            self._events = TopicMonitor(live, "/parameter_events")
            self._events.on_message = self._event
        self._events.look()
        nodes = [self.about] if self.about else self._with_parameters()
        if nodes != self._of:
            self._of, self._stale = nodes, True
        if self._stale:
            self._stale = False
            self.work(self._read, group="read")
        super().look(now)

    def _with_parameters(self) -> list[str]:
        assert self.hub.live is not None
        servers = {
            e.node_name for e in self.hub.live.cache.endpoints(Kind.SERVICE) if e.name.endswith("/list_parameters")
        }
        return [n for n in self.hub.nodes() if n in servers][:NODES]

    def _event(self, message: ParameterEvent, _: float) -> None:
        node = str(message.node)
        if node in self._of:
            self._stale = True
            for parameter in [*message.new_parameters, *message.changed_parameters]:
                self._changed.add((node, str(parameter.name)))

    async def _read(self) -> None:
        live, nodes = self.hub.live, list(self._of)
        assert live is not None
        rows: dict[str, Row] = {}
        self._trouble = ""
        for node in nodes:
            try:
                for row in await live.ask(partial(_read_node, node=node)):
                    rows[f"{row.node} {row.name}"] = row
            except GraphflowError as error:
                self._trouble = plain_text(str(error))
        self._rows, self._is_reading = rows, False

    def rows(self) -> dict[str, Cells]:
        colours = self.colours
        found: dict[str, Cells] = {}
        node = ""
        for key, row in self._rows.items():
            if row.node != node and not self.about:
                node = row.node
                found[f"{node} "] = (
                    Text(node, style=colours.node(node) + colours.strong),
                    "",
                    "",
                    "",
                    "",
                    "",
                )
            source = self._source(row)
            found[key] = (
                Text(
                    row.name if self.about else f"  {row.name}",
                    style=colours.dim if row.read_only else colours.text,
                ),
                Text(
                    plain_text(flow(row.value))[:60],
                    style=colours.accent if source == "changed" else colours.strong,
                ),
                Text(source, style=colours.accent if source == "changed" else colours.dim),
                Text(row.limits, style=colours.dim),
                Text(TYPE_NAMES[row.type] + (", read-only" if row.read_only else ""), style=colours.dim),
                Text(row.doc, style=colours.dim),
            )
        return found

    def _source(self, row: Row) -> str:
        """Return the origin of a value, as far as it is known."""
        if (row.node, row.name) in self._changed:
            return "changed"
        plan = self.hub.plan
        planned = next((n for n in plan.nodes if n.name == row.node), None) if plan is not None else None
        if planned is None:
            return ""
        setting = planned.params.get(row.name)
        if setting is None:
            return "default"
        same = setting.value == row.value
        return f"{setting.place.file.rpartition('/')[2]}:{setting.place.line}" if same else "changed"

    # editing

    def on_data_table_row_selected(self) -> None:
        self.do_change()

    def do_change(self) -> None:
        row = self._rows.get(self.key)
        if row is None:
            return
        if row.read_only:
            self.say(f"{row.name} is read-only: it can be set in the graph file only", bad=True)
            return
        self._edited = self.key
        value = flow(row.value) if not isinstance(row.value, str) else row.value
        self._input.placeholder = f"{row.name}: {TYPE_NAMES[row.type]} {row.limits}"
        self._input.value = value
        self._input.add_class("shown")
        self._input.focus()
        self._input.cursor_position = len(value)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        if event.input is not self._input:
            return
        row = self._rows[self._edited]
        text = event.value
        self.work(lambda: self._change(row, text), group="set")

    async def _change(self, row: Row, text: str) -> None:
        await self._set(row, text)
        self._before.append((row, row.value))

    def do_undo(self) -> None:
        """Restore the previous value of the parameter that was set last."""
        if not self._before:
            self.say("no parameter was set in this pane")
            return
        row, value = self._before.pop()
        text = value if isinstance(value, str) and value else flow(value)
        self.work(lambda: self._set(row, text), group="set")

    async def _set(self, row: Row, text: str) -> None:
        live = self.hub.live
        assert live is not None

        def work(graph: Graph) -> str:
            remote = RemoteParameters(graph, row.node, REPLY_TIMEOUT)
            declared = remote.known(row.name)
            value = read_value(text, 0 if declared.dynamic_typing else declared.type)
            message = to_message(value, declared.type if value == [] else type_id(value))
            result = remote.set({row.name: message})[0]
            return "" if result.successful else str(result.reason) or "no reason was given"

        refused = await live.ask(work)
        if refused:
            raise ParameterError(f"{row.node} refuses: {plain_text(refused)}")
        self._changed.add((row.node, row.name))
        self._stale = True
        self._close_input()
        command = shlex.join(["param", "set", row.node, row.name, text])
        self.did(f"graphflow {command}")
        self.hub.announce(command)

    def _close_input(self) -> None:
        self._input.remove_class("shown")
        self.table.focus()

    def key_escape(self) -> None:
        self._close_input()
        super().key_escape()

    def do_save(self) -> None:
        from graphflow.graph.edit import with_params
        from graphflow.tui.widgets.file_changes import write_nodes

        changed: dict[str, dict[str, object]] = {}
        for node, name in self._changed:
            row = self._rows.get(f"{node} {name}")
            if row is not None:
                changed.setdefault(node, {})[name] = row.value
        if not changed:
            self.say("no parameter has changed since this pane was opened")
            return

        def change(text: str, keys: dict[str, tuple[str, ...]]) -> str:
            for node, values in changed.items():
                text = with_params(text, keys[node], values)
            return text

        write_nodes(self.console, set(changed), change, "the parameters changed here", self._changed.clear)

    def do_reload(self) -> None:
        self._stale = True

    def do_copy(self) -> None:
        row = self._rows.get(self.key)
        if row is not None:
            self.console.copy(flow(row.value))

    def closed(self) -> None:
        if self._events is not None:
            self._events.close()
            self._events = None


def _read_node(graph: Graph, node: str) -> list[Row]:
    remote = RemoteParameters(graph, node, REPLY_TIMEOUT)
    names = remote.names()
    described = remote.describe(names)
    if len(names) != len(remote.get(names)):
        raise CallError(f"{node} does not report its parameters")
    found = []
    for name, message in zip(names, remote.get(names), strict=True):
        declared = described.get(name)
        type_ = declared.type if declared is not None and declared.type in TYPE_NAMES else 0
        value = from_message(message)
        value = list(value) if isinstance(value, bytes) else value
        found.append(
            Row(
                node,
                plain_text(name),
                value,
                type_,
                _limits(declared),
                plain_text(str(declared.description)) if declared is not None else "",
                bool(declared is not None and declared.read_only),
            )
        )
    return found


def _limits(declared: ParameterDescriptor | None) -> str:
    if declared is None:
        return ""
    ranges: list[IntegerRange | FloatingPointRange] = [*declared.integer_range, *declared.floating_point_range]
    for limits in ranges:
        low, high = f"{limits.from_value:g}", f"{limits.to_value:g}"
        return f"{low} or more" if high == "inf" else f"{high} or less" if low == "-inf" else f"{low} to {high}"
    return plain_text(str(declared.additional_constraints))[:40]


VIEW = Params
