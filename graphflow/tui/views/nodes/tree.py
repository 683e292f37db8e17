"""Nodes as a tree: below each its topics, services and actions, and below those the nodes at the other end."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from rich.text import Text

from graphflow.machines.cache import ACTION_SEND_GOAL
from graphflow.names import is_hidden
from graphflow.tui.commands.actions import Action
from graphflow.tui.widgets.table import FIND, Cells, TableView
from graphflow.wire.liveliness import Entity, Kind

OTHER_END = {
    Kind.PUBLISHER: Kind.SUBSCRIPTION,
    Kind.SUBSCRIPTION: Kind.PUBLISHER,
    Kind.SERVICE: Kind.CLIENT,
    Kind.CLIENT: Kind.SERVICE,
}
ENDS = {
    Kind.PUBLISHER: "subscription",
    Kind.SUBSCRIPTION: "publisher",
    Kind.SERVICE: "client",
    Kind.CLIENT: "server",
}
WORDS = {
    Kind.PUBLISHER: "publishes",
    Kind.SUBSCRIPTION: "subscribes",
    Kind.SERVICE: "serves",
    Kind.CLIENT: "calls",
}
OF_EVERY_NODE = ("rcl_interfaces/", "type_description_interfaces/")
"""Types of the topics and services of every node."""


class Link(NamedTuple):
    """One end of a topic, service or action."""

    node: str
    kind: Kind
    name: str
    type: str
    is_action: bool

    @property
    def word(self) -> str:
        if self.is_action:
            return "has the action" if self.kind is Kind.SERVICE else "sends goals"
        return WORDS[self.kind]


def links(entities: Iterable[Entity]) -> Iterator[Link]:
    """Return the endpoints of a node's own code, those of an action as one; not the ones that every node has."""
    for entity in entities:
        if is_hidden(entity.node_name):  # another console
            continue
        if entity.name.endswith(ACTION_SEND_GOAL):
            type_ = entity.type.removesuffix("_SendGoal")
            yield Link(entity.node_name, entity.kind, entity.name.removesuffix(ACTION_SEND_GOAL), type_, is_action=True)
        elif entity.kind in WORDS and not is_hidden(entity.name) and not entity.type.startswith(OF_EVERY_NODE):
            yield Link(entity.node_name, entity.kind, entity.name, entity.type, is_action=False)


class Tree(TableView):
    """All nodes folded, or one node unfolded."""

    NAME = "tree"
    DOC = "each node's topics, services and actions, and who is at the other end"
    LEAST_WIDTH = 50
    EMPTY = "no nodes yet"
    COLUMNS = ("node", "link", "rate", "type")
    SHED = ("node", "link", "rate", "type")
    KEEPS = 2
    EVERY = 1.0
    ACTIONS = (
        Action("open_row", "open it", keys=("enter",), hint=True),
        Action("fold", "fold it, or not", keys=("space",), hint=True),
        FIND,
        Action("copy", "copy the name", keys=("y",)),
    )

    def rows(self) -> dict[str, Cells]:
        live, colours = self.hub.live, self.colours
        if live is None:
            return {}
        live.want("numbers")
        of_node: dict[str, list[Link]] = {}
        at_end: dict[tuple[Kind, str], list[Link]] = {}
        for link in sorted(set(links(live.others())), key=lambda link: (link.kind, link.name, link.node)):
            of_node.setdefault(link.node, []).append(link)
            at_end.setdefault((link.kind, link.name), []).append(link)
        found: dict[str, Cells] = {}
        for node in [self.about] if self.about else self.hub.nodes():
            node_links = of_node.get(node, [])
            head = Text.assemble((self._mark(node, node_links), colours.dim), (node, colours.node(node)))
            found[node] = (head, Text(_count(len(node_links), "link"), style=colours.dim), Text(""), Text(""))
            for link in node_links if self._is_open(node) else ():
                key = "\n".join((node, link.kind, link.name))
                ends = at_end.get((OTHER_END[link.kind], link.name), [])
                rate = None if link.is_action else live.numbers.published(link.name)
                head = Text.assemble(("   " + self._mark(key, ends), colours.dim), (link.name, colours.text))
                lacks = not ends and link.kind in (Kind.SUBSCRIPTION, Kind.CLIENT)
                word = Text(
                    f"{link.word}, {_count(len(ends), ENDS[link.kind])}",
                    style=colours.warn if lacks else colours.text,
                )
                hz = Text("" if rate is None else f"{rate:.1f} Hz", justify="right")
                found[key] = (head, word, hz, Text(link.type, style=colours.dim))
                for end in ends if self._is_open(key) else ():
                    head = Text.assemble((" " * 8, colours.dim), (end.node, colours.node(end.node)))
                    found[f"{key}\n{end.node}"] = (head, Text(end.word, style=colours.dim), Text(""), Text(""))
        return found

    def _is_open(self, key: str) -> bool:
        return bool(self.about) != (key in self._turned)

    def _mark(self, key: str, below: list[Link]) -> str:
        return "  " if not below else "▾ " if self._is_open(key) else "▸ "

    @property
    def _turned(self) -> list[str]:
        """The rows that are folded in the tree of one node, or unfolded in that of all."""
        turned: list[str] = self.options.setdefault("turned", [])
        return turned

    def chosen(self) -> dict[str, str]:
        return {"node": self.key.split("\n")[0]} if self.key else {}

    def on_data_table_row_selected(self) -> None:
        self.do_open_row()

    def do_open_row(self) -> None:
        """Open a topic's messages, a service's form, an action's goals, or the tree of the node at the other end."""
        _, *link = self.key.split("\n")
        if not self.key or not link:
            self.do_fold()
            return
        if len(link) == 3:
            self.open("tree", link[2])
            return
        kind, name = link
        is_action = any(e.is_action and e.name == name for e in links(self.hub.live.others() if self.hub.live else ()))
        is_topic = kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION)
        self.open("goals" if is_action else "echo" if is_topic else "calls", name)

    def do_fold(self) -> None:
        """Fold or unfold the selected row, or its parent."""
        key = "\n".join(self.key.split("\n")[:3])
        if key:
            self._turned.remove(key) if key in self._turned else self._turned.append(key)
            self.look(0.0)
            self.choose(key)

    def do_copy(self) -> None:
        self.console.copy(self.key.rpartition("\n")[2])


def _count(number: int, noun: str) -> str:
    return f"{number or 'no'} {noun}{'' if number == 1 else 's'}"


VIEW = Tree
