"""Deadlocks that the source shows before anything runs: what awaits which service while it holds what.

Followed are calls of declared clients, `await self.adder.call(...)`, and goals of declared action clients, in handlers
and in the methods that they call. Two ways into a deadlock are looked for:

1. One chain of calls returns to a group whose slots it holds itself. That is CERTAIN if every call on the way is
   made whatever happens, else it holds IF THIS BRANCH RUNS.
2. Chains that run at the same time wait for each other's groups: a ring of groups, each held while the next
   is waited for. That is POSSIBLE; it takes the right moment.

What cannot be followed (a client that is made at run time, a name that no node offers) is listed, never silently
dropped.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Literal

from graphflow.errors import Place
from graphflow.graph.checks.check import Interfaces, resolver
from graphflow.graph.plan import Plan, PlannedNode
from graphflow.interface import NO_GROUP, GroupChange, GroupInfo, HandlerInfo, Interface
from graphflow.machines.regrouping import Regrouping
from graphflow.reading import found_text

Grade = Literal["CERTAIN", "IF THIS BRANCH RUNS", "POSSIBLE", "unresolved"]
LONGEST = 40
"""Longest chain of calls that is followed."""
_BRANCHES = (ast.If, ast.For, ast.AsyncFor, ast.While, ast.Try, ast.IfExp, ast.Match, ast.BoolOp, ast.ExceptHandler)


@dataclass(frozen=True)
class Finding:
    """One way into a deadlock, or something that could not be followed."""

    grade: Grade
    place: Place
    text: str

    def __str__(self) -> str:
        return f"{self.place}: {self.grade}: {self.text}"


@dataclass(frozen=True)
class _Slot:
    """A group of a node, or a handler's own queue."""

    node: str
    name: str
    limit: int | None = field(compare=False, default=1)
    is_own: bool = field(compare=False, default=False)

    def __str__(self) -> str:
        own = f"{self.name} of {self.node}, which runs once at a time"
        return own if self.is_own else f"group {self.name!r} of {self.node}"


@dataclass(frozen=True)
class _Call:
    """A service or action that a handler waits for."""

    name: str
    place: Place
    is_certain: bool
    is_released: bool
    """Whether the handler has released its slot."""
    reply: _Slot | None = None
    """What the response needs to arrive."""


@dataclass(frozen=True)
class _Actor:
    """A handler of a node."""

    node: str
    handler: str
    kind: str
    slot: _Slot

    def __str__(self) -> str:
        return f"{self.kind} {self.handler} of {self.node}"


def findings(plan: Plan, interfaces: Interfaces) -> list[Finding]:
    """What the source of a plan's classes shows; each way into a deadlock once."""
    world = _World(plan.file)
    for node in plan.nodes:
        interface = interfaces.get(node.class_path)
        if isinstance(interface, Interface):
            world.add(node, interface)
    chains = list(world.chains())
    told = {slot for _, slots in chains for slot in slots}
    rings = [finding for finding, slots in world.rings() if not slots & told]
    found = [finding for finding, _ in chains] + rings + world.unresolved()
    return sorted(dict.fromkeys(found), key=lambda f: (f.grade == "unresolved", f.place))


def warnings(ways: list[Finding], file: str) -> list[str]:
    """What is reported when the graph is started: what is certain, and that there is more."""
    certain = [str(way) for way in ways if way.grade == "CERTAIN"]
    more = sum(way.grade in ("POSSIBLE", "IF THIS BRANCH RUNS") for way in ways)
    if not more:
        return certain
    what = "1 possible deadlock is" if more == 1 else f"{more} possible deadlocks are"
    return [*certain, f"{what} explained by: graphflow check {file}"]


class _World:
    """The handlers of a graph and the calls between them."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._regroupings: dict[str, Regrouping] = {}
        """What the file says of groups, by node."""
        self._calls: dict[_Actor, list[_Call]] = {}
        self._servers: dict[str, _Actor | None] = {}
        self._unresolved: list[Finding] = []

    def add(self, node: PlannedNode, interface: Interface) -> None:
        self._regroupings[node.name] = node.regrouping(self._file)
        names, source = resolver(node), _Source(interface)
        clients = {e.attribute: names.resolve(e.name, "service") for e in interface.endpoints if "client" in e.kind}
        replies = {e.attribute: _group(node, interface, e.group) for e in interface.endpoints if e.group}
        for handler in interface.handlers:
            if handler.kind == "task":
                continue
            actor = _Actor(node.name, handler.name, handler.kind, _slot(node, interface, handler))
            found = list(source.calls(handler.name))
            self._calls[actor] = [
                replace(c, name=clients[c.name], reply=replies.get(c.name)) for c in found if c.name in clients
            ]
            for place, what in source.lost_sight_of(handler.name, clients):
                self._unresolved.append(Finding("unresolved", place, f"{actor} {what}"))
            for call in found:
                if call.name not in clients:
                    text = f"{actor} calls self.{call.name}, which is made at run time"
                    self._unresolved.append(Finding("unresolved", call.place, text))
            for endpoint in interface.endpoints:
                if endpoint.kind in ("service", "action") and endpoint.attribute == handler.name:
                    self._offer(names.resolve(endpoint.name, "service"), actor)

    def _offer(self, name: str, actor: _Actor) -> None:
        """Note a server; of several, which will answer is not known."""
        self._servers[name] = actor if self._servers.get(name, actor) == actor else None

    def unresolved(self) -> list[Finding]:
        missing = [
            Finding("unresolved", call.place, f"{actor} calls {call.name}, which no node of this graph declares")
            for actor, calls in self._calls.items()
            for call in calls
            if call.name not in self._servers
        ]
        return [*self._unresolved, *missing]

    def chains(self) -> Iterator[tuple[Finding, frozenset[_Slot]]]:
        """Chains of calls that return to a group that they fill themselves."""
        seen: set[tuple[_Slot, Place]] = set()
        for actor, calls in self._calls.items():
            for call in calls:
                if (
                    call.reply is not None
                    and call.reply == actor.slot
                    and call.reply.limit == 1
                    and not call.is_released
                ):
                    grade: Grade = "CERTAIN" if call.is_certain else "IF THIS BRANCH RUNS"
                    text = (
                        f"{actor} awaits {call.name}, whose response needs {actor.slot}, which it holds itself. Let "
                        "replies through: declare the client without group="
                    )
                    yield Finding(grade, call.place, text), frozenset([actor.slot])
            for finding, slot, last in self._follow(actor, [], Counter([actor.slot])):
                if (slot, last) not in seen:
                    seen.add((slot, last))
                    yield finding, frozenset([slot])

    def _follow(self, actor: _Actor, path: list[_Call], held: Counter[_Slot]) -> Iterator[tuple[Finding, _Slot, Place]]:
        if len(path) >= LONGEST:
            return
        for call in self._calls[actor]:
            server = self._servers.get(call.name)
            if server is None:
                continue
            slot, way = server.slot, [*path, call]
            held[actor.slot] -= call.is_released
            if slot.limit is not None and held[slot] >= slot.limit:
                grade: Grade = "CERTAIN" if all(c.is_certain for c in way) else "IF THIS BRANCH RUNS"
                text = (
                    f"{actor} awaits {call.name}, whose handler {server.handler} needs {slot}, "
                    f"which the chain of calls itself holds: {self._told(way)}"
                )
                yield (
                    Finding(grade, call.place, f"{text}. {self._remedy(server, actor)}"),
                    slot,
                    call.place,
                )
            else:
                held[slot] += 1
                yield from self._follow(server, way, held)
                held[slot] -= 1
            held[actor.slot] += call.is_released

    def _remedy(self, server: _Actor, actor: _Actor) -> str:
        return _remedy(server, actor, self._regroupings[server.node])

    def _told(self, way: list[_Call]) -> str:
        return ", then ".join(f"{call.name} ({Path(call.place.file).name}:{call.place.line})" for call in way)

    def rings(self) -> Iterator[tuple[Finding, frozenset[_Slot]]]:
        """Groups that are each held while the next is waited for."""
        edges: dict[_Slot, dict[_Slot, tuple[_Actor, _Call, _Actor]]] = {}
        for actor, calls in self._calls.items():
            for call in calls:
                server = self._servers.get(call.name)
                if server is None or call.is_released:
                    continue
                if server.slot.limit is not None and actor.slot.limit is not None:
                    edges.setdefault(actor.slot, {}).setdefault(server.slot, (actor, call, server))
        done: set[frozenset[_Slot]] = set()
        for start in edges:
            ring = _ring(start, edges)
            if ring is None or frozenset(ring) in done or len(ring) < 2:
                continue
            done.add(frozenset(ring))
            steps = [edges[a][b] for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)]
            told = "; ".join(
                f"{actor} holds {actor.slot} and awaits {call.name} ({Path(call.place.file).name}:{call.place.line})"
                for actor, call, _ in steps
            )
            actor, call, server = steps[0]
            remedy = self._remedy(server, actor)
            yield Finding("POSSIBLE", call.place, f"{told}. {remedy}"), frozenset(ring)


def _ring(start: _Slot, edges: Mapping[_Slot, Mapping[_Slot, object]]) -> list[_Slot] | None:
    """A shortest ring of groups through `start`."""
    before: dict[_Slot, _Slot] = {}
    todo = [start]
    while todo:
        here = todo.pop(0)
        for following in edges.get(here, {}):
            if following == start:
                way = [here]
                while way[-1] != start:
                    way.append(before[way[-1]])
                return way[::-1]
            if following not in before:
                before[following] = here
                todo.append(following)
    return None


def _remedy(server: _Actor, actor: _Actor, regrouping: Regrouping) -> str:
    """What ends it, with the line for the graph file, which keeps what the file says already."""
    handler = server.handler
    if server.slot.is_own and server.kind == "action":
        return f"Let several goals run at a time: policy='parallel' where {handler} is declared"
    if server == actor and not server.slot.is_own:
        told, changed = (
            "Allow as many runs as the recursion is deep, in place of 2",
            regrouping.limited(server.slot.name, 2),
        )
    elif server.slot.is_own:
        told = f"Let several runs of {handler} overlap: give it a group without a limit"
        changed = regrouping.moved([handler], f"{handler}_group").limited(f"{handler}_group", None)
    else:
        told, changed = f"Give {handler} a group of its own", regrouping.moved([handler], f"{handler}_group")
    return f"{told}, {changed.where} {' '.join(line.strip() for line in changed.lines(server.node, ''))}"


def _slot(node: PlannedNode, interface: Interface, handler: HandlerInfo) -> _Slot:
    """The group whose slot a handler's runs take: as the graph file says, else as the class does."""
    name = handler.group
    for group, planned in node.concurrency.items():
        if handler.name in planned.change.handlers:
            name = "" if group == NO_GROUP else group
    if not name:
        return _Slot(node.name, handler.name, 1, is_own=True)
    return _group(node, interface, name)


def _group(node: PlannedNode, interface: Interface, name: str) -> _Slot:
    declared = interface.groups.get(name, GroupInfo())
    change = node.concurrency[name].change if name in node.concurrency else GroupChange()
    if (change.when_full or declared.when_full) == "cancel_running":
        return _Slot(node.name, name, None)  # it is never full for good
    return _Slot(node.name, name, change.limit if change.sets_limit else declared.limit)


class _Source:
    """The methods of a class, read but not run."""

    def __init__(self, interface: Interface) -> None:
        files = dict.fromkeys([interface.place.file, *(h.place.file for h in interface.handlers)])
        classes: dict[str, tuple[str, ast.ClassDef]] = {}
        for file in files:
            for node in ast.walk(_module(file)):
                if isinstance(node, ast.ClassDef):
                    classes.setdefault(node.name, (file, node))
        self._methods: dict[str, tuple[str, ast.FunctionDef | ast.AsyncFunctionDef]] = {}
        todo = [interface.class_path.rpartition(":")[2].rpartition(".")[2]]
        seen: set[str] = set()
        while todo:
            name = todo.pop(0)
            if name in seen or name not in classes:
                continue
            seen.add(name)
            file, definition = classes[name]
            for item in definition.body:
                if isinstance(item, (ast.FunctionDef, ast.AsyncFunctionDef)):
                    self._methods.setdefault(item.name, (file, item))
            todo += [base.id for base in definition.bases if isinstance(base, ast.Name)]

    def calls(
        self, method: str, *, certain: bool = True, released: bool = False, seen: frozenset[str] = frozenset()
    ) -> Iterator[_Call]:
        """What a method awaits by `self.<attribute>.call(...)`, itself or in methods that it calls."""
        if method not in self._methods or method in seen:
            return
        file, function = self._methods[method]
        leaves, free = _first_way_out(function), _released(function)
        for node, reached in _walk(function, True):
            always = reached and (leaves is None or getattr(node, "lineno", 0) < leaves)
            if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
                continue
            held = node.func.value
            if node.func.attr in ("call", "call_sync", "send", "send_goal") and _is_own(held):
                assert isinstance(held, ast.Attribute)
                yield _Call(held.attr, Place(file, node.lineno), certain and always, released or node in free)
            elif _is_own(node.func):
                yield from self.calls(
                    node.func.attr,
                    certain=certain and always,
                    released=released or node in free,
                    seen=seen | {method},
                )

    def lost_sight_of(
        self, method: str, clients: Collection[str], seen: frozenset[str] = frozenset()
    ) -> Iterator[tuple[Place, str]]:
        """Where clients get out of sight: handed to other code, or called in a task of their own."""
        if method not in self._methods or method in seen:
            return
        file, function = self._methods[method]
        for node in ast.walk(function):
            if isinstance(node, ast.Call) and _is_own(node.func):
                assert isinstance(node.func, ast.Attribute)
                yield from self.lost_sight_of(node.func.attr, clients, seen | {method})
            is_task = isinstance(node, ast.Call) and _word(node.func) in _TASK_MAKERS
            for child in ast.walk(node) if is_task else ():
                if _is_own(child) and isinstance(child, ast.Attribute) and child.attr in clients:
                    yield Place(file, child.lineno), f"uses self.{child.attr} in a task, whose end is not followed"
            handed = [*node.args, *(k.value for k in node.keywords)] if isinstance(node, ast.Call) else []
            handed += [node.value] if isinstance(node, (ast.Assign, ast.Return)) and node.value is not None else []
            for value in handed:
                if _is_own(value) and isinstance(value, ast.Attribute) and value.attr in clients:
                    yield Place(file, value.lineno), f"hands self.{value.attr} on, and its calls there are not followed"


_TASK_MAKERS = ("create_task", "ensure_future", "spawn")


def _walk(node: ast.AST, always: bool) -> Iterator[tuple[ast.AST, bool]]:
    """A function's nodes, and whether they are reached whenever it runs; without the functions inside it."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            continue
        # The handler does not wait for a task that it makes and does not await.
        if isinstance(child, ast.Call) and _word(child.func) in _TASK_MAKERS:
            continue
        reached = always and not isinstance(child, _BRANCHES)
        yield child, reached
        yield from _walk(child, reached)


def _first_way_out(function: ast.AST) -> int | None:
    """The line of the first `return` or `raise` that only some runs take: what follows is not reached by all."""
    lines = [n.lineno for n, reached in _walk(function, True) if isinstance(n, (ast.Return, ast.Raise)) and not reached]
    return min(lines, default=None)


def _released(function: ast.AST) -> set[ast.AST]:
    """What is inside `async with self.group.released()`."""
    blocks = [
        node
        for node in ast.walk(function)
        if isinstance(node, ast.AsyncWith)
        for item in node.items
        if isinstance(item.context_expr, ast.Call) and _word(item.context_expr.func) == "released"
    ]
    return {node for block in blocks for statement in block.body for node in ast.walk(statement)}


def _word(function: ast.AST) -> str:
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def _is_own(node: ast.AST) -> bool:
    return isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self"


@cache
def _module(file: str) -> ast.Module:
    try:
        text = found_text(Path(file))
        try:
            return ast.parse(text)
        except SystemError:  # CPython until 3.11.7: another thread has parsed something meanwhile (gh-106905)
            return ast.parse(text)
    except (OSError, SyntaxError, UnicodeDecodeError):
        return ast.Module([], [])
