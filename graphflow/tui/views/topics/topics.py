"""The topics of the graph or of a node: types, endpoints, rates and mismatches."""

from __future__ import annotations

from rich.text import Text

from graphflow.introspect.drawing.picture import misfit
from graphflow.tui.commands.actions import Action
from graphflow.tui.widgets.table import FIND, ORDER, Cells, TableView
from graphflow.wire.liveliness import Entity, Kind


class Topics(TableView):
    """The list of topics."""

    NAME = "topics"
    DOC = "every topic: type, publishers, subscriptions, rate"
    LEAST_WIDTH = 56
    EMPTY = "no topics yet; a shows hidden ones"
    COLUMNS = ("topic", "type", "pub", "sub", "rate", "fits")
    SHED = ("topic", "pub", "sub", "fits", "rate", "type")
    KEEPS = 1
    EVERY = 1.0
    ACTIONS = (
        Action("echo", "echo", keys=("enter", "e"), verb="graphflow topic echo {topic}", hint=True),
        Action("hz", "rate", keys=("h",), hint=True),
        Action("plot", "plot", keys=("p",), hint=True),
        Action("info", "info", keys=("i",), verb="graphflow topic info -v {topic}", hint=True),
        Action("hidden", "hidden ones too", keys=("a",)),
        FIND,
        ORDER,
        Action("copy", "copy the name", keys=("y",)),
    )

    shows_hidden = False

    def rows(self) -> dict[str, Cells]:
        live, colours = self.hub.live, self.colours
        if live is None:
            return {}
        live.want("numbers")
        ends: dict[str, list[Entity]] = {}
        for entity in live.others():
            if entity.kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION):
                ends.setdefault(entity.name, []).append(entity)
        found: dict[str, Cells] = {}
        for name, types in live.cache.topics(hidden=self.shows_hidden).items():
            endpoints = ends.get(name, [])
            if self.about and not any(e.node_name == self.about for e in endpoints):
                continue
            publishers = sum(e.kind is Kind.PUBLISHER for e in endpoints)
            rate = live.numbers.published(name)
            trouble = misfit(endpoints)
            found[name] = (
                Text(name, style=colours.text),
                Text(", ".join(types), style=colours.dim),
                Text(str(publishers or ""), justify="right"),
                Text(str(len(endpoints) - publishers or ""), justify="right"),
                Text("" if rate is None else f"{rate:.1f} Hz", justify="right"),
                Text(f"✖ {trouble}" if trouble else "", style=colours.bad),
            )
        return found

    def chosen(self) -> dict[str, str]:
        return {"topic": self.key} if self.key else {}

    def on_data_table_row_selected(self) -> None:
        self.do_echo()

    def do_echo(self) -> None:
        self._open("echo", "topic echo")

    def do_hz(self) -> None:
        self._open("hz", "topic hz")

    def _open(self, view: str, verb: str) -> None:
        if self.key:
            self.did(f"graphflow {verb} {self.key}")
            self.open(view, self.key)

    def do_plot(self) -> None:
        if self.key:
            self.open("plot", self.key)

    def do_info(self) -> None:
        if self.key:
            self.open("prompt", f"topic info -v {self.key}", run=True)

    def do_hidden(self) -> None:
        self.shows_hidden = not self.shows_hidden
        self.look(0.0)

    def do_copy(self) -> None:
        self.console.copy(self.key)


VIEW = Topics
