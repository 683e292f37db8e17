"""Static detection of deadlocks in a graph: chains of calls and lock orders, read before anything runs.

Calls of declared clients, `await self.adder.call(...)`, and goals of declared action clients are followed in handlers
and in the methods that they call. Each handler holds a slot of its group during its calls, so a group is a lock, and a
call orders two locks: the caller's group before the server's. Two kinds of deadlock follow:

1. A chain of calls returns to a group whose slots the chain itself holds: an attempt to take a lock again that is not
   reentrant. It is CERTAIN if every run makes all the calls, else it happens IF THIS BRANCH RUNS.
2. The lock order has a cycle: chains that run at the same time can each hold one group and wait for the next. That is
   POSSIBLE; it takes the right moment.

Calls that cannot be followed (a client that is created at run time, a name that no node offers) are listed as
unresolved, never silently dropped.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Literal

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk
from graphflow.errors import Place
from graphflow.graph.checks.check import Interfaces, resolver
from graphflow.graph.plan import Plan, PlannedNode
from graphflow.interface import NO_GROUP, GroupChange, GroupInfo, HandlerInfo, Interface, may_make
from graphflow.machines.regrouping import Regrouping
from graphflow.reading import found_text, parsed

Grade = Literal["CERTAIN", "IF THIS BRANCH RUNS", "POSSIBLE", "unresolved"]
LONGEST = 40
"""Longest chain of calls that is followed."""
_BRANCHES = (ast.If, ast.For, ast.AsyncFor, ast.While, ast.Try, ast.IfExp, ast.Match, ast.BoolOp, ast.ExceptHandler)
"""Nodes whose parts do not run every time."""
_TASK_MAKERS = ("create_task", "ensure_future", "spawn")
"""Functions that start a task, which runs beside its caller."""


@dataclass(frozen=True)
class Finding:
    """A possible deadlock, or a call that could not be followed."""

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
    """Slot that the delivery of the response needs, if its client is in a group."""


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
    """Return the findings in the classes of a plan, each deadlock once."""
    calls = _CallGraph(plan.file)
    for node in plan.nodes:
        interface = interfaces.get(node.class_path)
        if isinstance(interface, Interface):
            calls.add(node, interface)
    chains = list(calls.chains())
    # A chain that deadlocks by itself also makes a ring of its groups, which would be reported twice.
    known = {slot for _, slots in chains for slot in slots}
    rings = [finding for finding, slots in calls.rings() if not slots & known]
    found = [finding for finding, _ in chains] + rings + calls.unresolved()
    return sorted(dict.fromkeys(found), key=lambda f: (f.grade == "unresolved", f.place))


def warnings(found: list[Finding], file: str) -> list[str]:
    """Return the warnings for the start of a graph: the certain findings, and the number of others."""
    certain = [str(finding) for finding in found if finding.grade == "CERTAIN"]
    more = sum(finding.grade in ("POSSIBLE", "IF THIS BRANCH RUNS") for finding in found)
    if not more:
        return certain
    what = "1 possible deadlock is" if more == 1 else f"{more} possible deadlocks are"
    return [*certain, f"{what} explained by: graphflow check {file}"]


class _CallGraph:
    """The handlers of a graph and the calls between them."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._regroupings: dict[str, Regrouping] = {}
        """By node: the changes of its groups that the file makes."""
        self._calls: dict[_Actor, list[_Call]] = {}
        self._servers: dict[str, _Actor | None] = {}
        """By service or action: its server; None if there are several, any of which may answer."""
        self._unresolved: list[Finding] = []
        self._dynamic: list[bool | Sequence[str]] = []
        """By node: the names that it may make at run time."""

    def add(self, node: PlannedNode, interface: Interface) -> None:
        """Add the handlers of a node, with their calls."""
        self._regroupings[node.name] = node.regrouping(self._file)
        self._dynamic.append(interface.dynamic_names)
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
                if call.name not in clients and call.name not in interface.attributes:
                    text = f"{actor} calls self.{call.name}, which is made at run time"
                    self._unresolved.append(Finding("unresolved", call.place, text))
            for endpoint in interface.endpoints:
                if endpoint.kind in ("service", "action") and endpoint.attribute == handler.name:
                    self._offer(names.resolve(endpoint.name, "service"), actor)

    def _offer(self, name: str, actor: _Actor) -> None:
        """Add the server of a name."""
        self._servers[name] = actor if self._servers.get(name, actor) == actor else None

    def _may_be_made(self, name: str) -> bool:
        """Whether a node of the graph makes servers of such names at run time."""
        return any(may_make(dynamic, name) for dynamic in self._dynamic)

    def unresolved(self) -> list[Finding]:
        """Return the calls that could not be followed."""
        missing = [
            Finding("unresolved", call.place, f"{actor} calls {call.name}, which no node of this graph declares")
            for actor, calls in self._calls.items()
            for call in calls
            if call.name not in self._servers and not self._may_be_made(call.name)
        ]
        return [*self._unresolved, *missing]

    def chains(self) -> Iterator[tuple[Finding, frozenset[_Slot]]]:
        """Yield the chains of calls that return to a group which they fill themselves, with the group."""
        seen: set[tuple[_Slot, Place]] = set()
        for actor, calls in self._calls.items():
            for call in calls:
                is_same = call.reply is not None and call.reply == actor.slot and call.reply.limit == 1
                if is_same and not call.is_released:
                    text = (
                        f"{actor} awaits {call.name}, whose response needs {actor.slot}, which it holds itself. Let "
                        "replies through: declare the client without group="
                    )
                    yield Finding(_grade([call]), call.place, text), frozenset([actor.slot])
            for finding, slot, last in self._follow(actor, [], Counter([actor.slot])):
                if (slot, last) not in seen:
                    seen.add((slot, last))
                    yield finding, frozenset([slot])

    def _follow(self, actor: _Actor, path: list[_Call], held: Counter[_Slot]) -> Iterator[tuple[Finding, _Slot, Place]]:
        """Follow the calls of a handler, depth first; recursion ends at the first group that is full.

        Args:
            path: The calls that led to the handler.
            held: Number of slots that the chain holds, by group; as before when the generator is exhausted.
        """
        if len(path) >= LONGEST:
            return
        for call in self._calls[actor]:
            server = self._servers.get(call.name)
            if server is None:
                continue
            slot, chain = server.slot, [*path, call]
            # A caller that has released its slot does not hold it during this call.
            held[actor.slot] -= call.is_released
            if slot.limit is not None and held[slot] >= slot.limit:
                text = (
                    f"{actor} awaits {call.name}, whose handler {server.handler} needs {slot}, "
                    f"which the chain of calls itself holds: {_listing(chain)}. {self._remedy(server, actor)}"
                )
                yield Finding(_grade(chain), call.place, text), slot, call.place
            else:
                held[slot] += 1
                yield from self._follow(server, chain, held)
                held[slot] -= 1
            held[actor.slot] += call.is_released

    def _remedy(self, server: _Actor, actor: _Actor) -> str:
        return _remedy(server, actor, self._regroupings[server.node])

    def rings(self) -> Iterator[tuple[Finding, frozenset[_Slot]]]:
        """Yield the cycles in the lock order of groups, each once, with its groups."""
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
            text = "; ".join(f"{actor} holds {actor.slot} and awaits {_listing([call])}" for actor, call, _ in steps)
            actor, call, server = steps[0]
            remedy = self._remedy(server, actor)
            yield Finding("POSSIBLE", call.place, f"{text}. {remedy}"), frozenset(ring)


def _grade(chain: Sequence[_Call]) -> Grade:
    return "CERTAIN" if all(call.is_certain for call in chain) else "IF THIS BRANCH RUNS"


def _listing(chain: Sequence[_Call]) -> str:
    return ", then ".join(f"{call.name} ({Path(call.place.file).name}:{call.place.line})" for call in chain)


def _ring(start: _Slot, edges: Mapping[_Slot, Mapping[_Slot, object]]) -> list[_Slot] | None:
    """Return a shortest ring of groups through `start`, by breadth-first search; None if there is none."""
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
    """Return the remedy, with the line for the graph file, which repeats the file's other changes."""
    handler = server.handler
    if server.slot.is_own and server.kind == "action":
        return f"Let several goals run at a time: policy='parallel' where {handler} is declared"
    if server == actor and not server.slot.is_own:
        text = "Allow as many runs as the recursion is deep, in place of 2"
        changed = regrouping.limited(server.slot.name, 2)
    elif server.slot.is_own:
        text = f"Let several runs of {handler} overlap: give it a group without a limit"
        changed = regrouping.moved([handler], f"{handler}_group").limited(f"{handler}_group", None)
    else:
        text, changed = f"Give {handler} a group of its own", regrouping.moved([handler], f"{handler}_group")
    return f"{text}, {changed.where} {' '.join(line.strip() for line in changed.lines(server.node, ''))}"


def _slot(node: PlannedNode, interface: Interface, handler: HandlerInfo) -> _Slot:
    """Return the group whose slot a handler's runs take: that of the graph file, or else of the class."""
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
        return _Slot(node.name, name, None)  # a new run cancels the one that holds the slot, so it is never full
    return _Slot(node.name, name, change.limit if change.sets_limit else declared.limit)


class _Source:
    """The methods of a class, read but not run."""

    def __init__(self, interface: Interface) -> None:
        files = dict.fromkeys([interface.place.file, *(h.place.file for h in interface.handlers)])
        classes: dict[str, tuple[str, ast.ClassDef]] = {}
        for file in files:
            for node in nodes_in(_module(file)):
                if isinstance(node, ast.ClassDef):
                    classes.setdefault(node.name, (file, node))
        self._methods: dict[str, tuple[str, FunctionNode]] = {}
        todo = [interface.class_path.rpartition(":")[2].rpartition(".")[2]]
        seen: set[str] = set()
        while todo:
            # Breadth first: Python's order of base classes, but for diamonds.
            name = todo.pop(0)
            if name in seen or name not in classes:
                continue
            seen.add(name)
            file, definition = classes[name]
            for item in definition.body:
                if isinstance(item, FunctionNode):
                    self._methods.setdefault(item.name, (file, item))
            todo += [base.id for base in definition.bases if isinstance(base, ast.Name)]

    def calls(
        self, method: str, *, certain: bool = True, released: bool = False, seen: frozenset[str] = frozenset()
    ) -> Iterator[_Call]:
        """Yield the calls `self.<attribute>.call(...)` in a method and in the methods that it calls.

        Args:
            certain: Whether every run of the handler calls the method.
            released: Whether the handler has released its slot by then.
            seen: The methods that led to it.
        """
        if method not in self._methods or method in seen:
            return
        file, function = self._methods[method]
        exit_line, free = _first_exit(function), _released(function)
        for node, reached in _own_code(function):
            if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
                continue
            is_certain = certain and reached and (exit_line is None or node.lineno < exit_line)
            is_released, owner = released or node in free, node.func.value
            if node.func.attr in ("call", "call_sync", "send", "send_goal") and is_own(owner):
                yield _Call(owner.attr, Place(file, node.lineno), is_certain, is_released)
            elif is_own(node.func):
                inner = node.func.attr
                yield from self.calls(inner, certain=is_certain, released=is_released, seen=seen | {method})

    def lost_sight_of(
        self, method: str, clients: Collection[str], seen: frozenset[str] = frozenset()
    ) -> Iterator[tuple[Place, str]]:
        """Yield the uses of clients whose calls cannot be followed: passed to other code, or in a task.

        Each is a place with the verb phrase for the report.
        """
        if method not in self._methods or method in seen:
            return
        file, function = self._methods[method]
        for node in nodes_in(function):
            if isinstance(node, ast.Call) and is_own(node.func):
                yield from self.lost_sight_of(node.func.attr, clients, seen | {method})
            is_task = isinstance(node, ast.Call) and last_name(node.func) in _TASK_MAKERS
            for child in nodes_in(node) if is_task else ():
                if is_own(child) and child.attr in clients:
                    yield Place(file, child.lineno), f"uses self.{child.attr} in a task, whose end is not followed"
            for value in _passed_on(node):
                if is_own(value) and value.attr in clients:
                    yield Place(file, value.lineno), f"hands self.{value.attr} on, and its calls there are not followed"


def _passed_on(node: ast.AST) -> list[ast.expr]:
    """Return the expressions that a node passes to other code or gives another name."""
    match node:
        case ast.Call(args=arguments, keywords=keywords):
            return [*arguments, *(keyword.value for keyword in keywords)]
        case ast.Assign(value=value) | ast.Return(value=ast.expr() as value):
            return [value]
    return []


def _own_code(function: ast.AST) -> Iterator[tuple[ast.AST, bool]]:
    """Yield the nodes of a function's own code, each with whether every run reaches it.

    Tasks that it starts without awaiting them are left out, too: their waits do not delay it.
    """
    tasks: set[ast.AST] = set()
    for node, parents in walk(function, into_functions=False):
        is_task = isinstance(node, ast.Call) and last_name(node.func) in _TASK_MAKERS
        if is_task or (parents and parents[-1] in tasks):
            tasks.add(node)
        elif parents:
            yield node, not any(isinstance(n, _BRANCHES) for n in (node, *parents))


def _first_exit(function: ast.AST) -> int | None:
    """Return the line of the first `return` or `raise` that only some runs take: others may not get beyond it."""
    lines = [n.lineno for n, reached in _own_code(function) if isinstance(n, (ast.Return, ast.Raise)) and not reached]
    return min(lines, default=None)


def _released(function: ast.AST) -> set[ast.AST]:
    """Return the nodes inside `async with self.group.released()`."""
    blocks = [
        node
        for node in nodes_in(function)
        if isinstance(node, ast.AsyncWith)
        for item in node.items
        if isinstance(item.context_expr, ast.Call) and last_name(item.context_expr.func) == "released"
    ]
    return {node for block in blocks for statement in block.body for node in nodes_in(statement)}


@cache
def _module(file: str) -> ast.Module:
    try:
        return parsed(found_text(Path(file)))
    except (OSError, SyntaxError, ValueError):
        return ast.Module([], [])
