"""Static detection of deadlocks in rclpy nodes: callbacks that wait for something that they keep from running.

A callback holds two resources until it returns: its callback group, if that is exclusive, and a thread of its executor.
It deadlocks if it blocks until another callback has run that needs one of them: the callback of a response, of a
service in the same group, or the one that sets a polled flag.

Files are read one at a time, and not run. The callbacks of a class are those that it registers by `create_timer` and
its siblings; a callback group is known if it is created or named in the same class. Anything else is skipped.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from graphflow.analysis.deadlock_check import Finding, Grade
from graphflow.analysis.rclpy_flags import Polled, changers, polled, written_from_outside
from graphflow.analysis.rclpy_futures import SPINS, dotted, futures_of, polled_futures
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk
from graphflow.analysis.uncalled import uncalled_methods
from graphflow.analysis.unspun_waits import unspun_waits
from graphflow.errors import Place
from graphflow.reading import found_text

FILES_BOUND = 2000
"""Files that are read below a folder, at most."""
_LEFT_OUT = {"build", "install", "log", "node_modules", "venv", "site-packages", "__pycache__"}
_BASES = {"Node", "LifecycleNode"}
_CALLBACK_AT = {"create_timer": 1, "create_subscription": 2, "create_service": 2, "ActionServer": 3}
"""Position of the callback among the arguments, by function."""
_GROUP_AT = {"create_timer": 2}
"""Position of the callback group, where it is not an argument by keyword only."""
_SERVERS = ("create_service", "ActionServer")
_OF_ONE_THREAD = {"SingleThreadedExecutor", "EventsExecutor", "ThreadPoolExecutor", "ProcessPoolExecutor"}
"""Executors of rclpy with one thread, and classes of that ending that are not rclpy's."""
_KINDS = {"create_timer": "timer", "create_subscription": "subscription", "create_service": "service"}
_BRANCHES = (ast.If, ast.For, ast.While, ast.Try, ast.IfExp, ast.Match, ast.ExceptHandler)
_OWN = "callback_group=MutuallyExclusiveCallbackGroup()"
_POOL = "spin with MultiThreadedExecutor()"


class _Group(NamedTuple):
    """A callback group."""

    name: str
    is_exclusive: bool

    def __str__(self) -> str:
        return self.name or "a callback group"


_DEFAULT = _Group("the default callback group", True)


class _Callback(NamedTuple):
    """A method that an executor calls."""

    method: str
    kind: str
    group: _Group | None
    """None if it is in no group, or in an unknown one."""

    def __str__(self) -> str:
        return f"{self.kind} {self.method}"


class _Server(NamedTuple):
    """A server of a service or action."""

    what: str
    """Its method, or `the action server`."""
    name: str
    """Name of the service or action, as the code writes it."""
    group: _Group | None


class _Wait(NamedTuple):
    """A wait in a method."""

    what: str
    """The expression that waits: `self.client.call`."""
    line: int
    client: str
    """Attribute of the client whose response it waits for; empty for another wait."""
    holds_thread: bool
    """Whether it blocks its thread, rather than awaits."""
    spins: bool
    """Whether it spins an executor meanwhile, so that other callbacks run on its thread."""
    is_certain: bool
    """Whether every run of the callback reaches it."""
    polled: Polled | None = None
    """The loop, if it polls attributes."""


class _Scope(NamedTuple):
    """The names of one function that its waits refer to."""

    function: FunctionNode
    futures: Mapping[str, str]
    """Names of futures, each with the client that it comes from."""
    rates: set[str]
    """Names of rates, with their `self.` if they are attributes."""


@dataclass
class _Class:
    """A node's class."""

    file: str
    is_single: bool
    """Whether one thread spins it."""
    doubled: frozenset[str] = frozenset()
    """Names of services with several servers in the file."""
    written: frozenset[str] = frozenset()
    """Attributes that the file assigns on something other than `self`."""
    methods: dict[str, FunctionNode] = field(default_factory=dict)
    groups: dict[str, _Group] = field(default_factory=dict)
    clients: dict[str, _Group | None] = field(default_factory=dict)
    called: dict[str, str] = field(default_factory=dict)
    """By client: the name of the service or action, as the code writes it."""
    servers: list[_Server] = field(default_factory=list)
    callbacks: list[_Callback] = field(default_factory=list)
    rates: set[str] = field(default_factory=set)
    """Attributes with a rate, with their `self.`."""
    events: set[str] = field(default_factory=set)
    """Attributes with a `threading.Event`."""

    def findings(self) -> Iterator[Finding]:
        """Yield the deadlocks of the class's callbacks and of its constructor."""
        seen: set[tuple[int, str]] = set()
        for callback in self.callbacks:
            for wait in self._waits(callback.method, True, set()):
                text = self._fault(callback, wait)
                if text and (wait.line, callback.method) not in seen:
                    seen.add((wait.line, callback.method))
                    yield Finding(_grade(wait), Place(self.file, wait.line), text)
        for wait in self._waits("__init__", True, set()):
            if wait.holds_thread and not wait.spins:
                way = _later(wait) if wait.client else "go on in a timer, or in the callback that it waits for"
                text = f"__init__ waits in {wait.what}, and nobody spins the node before it is made: {way}"
                yield Finding(_grade(wait), Place(self.file, wait.line), text)

    def unfollowed(self) -> Iterator[Place]:
        """Yield the polling loops in callbacks whose condition may change in ways that the source does not show."""
        for callback in self.callbacks:
            for wait in self._waits(callback.method, True, set()):
                if wait.polled is not None and not wait.polled.gives_up and self._changers(wait.polled) is None:
                    yield Place(self.file, wait.line)

    def _changers(self, poll: Polled) -> frozenset[str] | None:
        """Return the methods that change the attributes a loop polls; None if others may do so, too."""
        if not poll.flags or poll.flags & self.written:
            return None
        found = changers(poll.flags, self.methods, frozenset(callback.method for callback in self.callbacks))
        return found.methods if found.is_known else None

    def _poll_fault(self, callback: _Callback, wait: _Wait, poll: Polled) -> str:
        """Return the report of a loop that polls for ever; empty if it may end."""
        setting = None if poll.gives_up else self._changers(poll)
        if not setting:
            return ""
        others, group = sorted(setting - {callback.method}), callback.group
        by = [other for other in self.callbacks if other.method in setting]
        what, setters = " and ".join(f"self.{flag}" for flag in sorted(poll.flags)), " and ".join(others)
        one = "s" if len(others) < 2 else ""
        needs = (
            f"{callback} waits in {wait.what}, and {setters or 'only its next run'}, which set{one} {what}, need{one}"
        )
        is_kept_out = setting == {other.method for other in by} and all(other.group == group for other in by)
        later = f"return instead of waiting, and go on in {setters or 'its next call'}"
        if is_kept_out and group is not None and group.is_exclusive:
            text = f"{needs} {group}, which {callback.method} holds until it returns: {later}"
        elif self.is_single and not wait.spins:
            text = f"{needs} a thread that spins, and the only one is in {callback.method}: {later}"
        else:
            return ""
        if not others:  # each further run would wait as well
            return text
        return f"{text}; or make {callback.method} with {_OWN}{'' if wait.spins else f', and {_POOL}'}"

    def _fault(self, callback: _Callback, wait: _Wait) -> str:
        """Return the report of a wait that never ends; empty if it may."""
        if wait.polled is not None:
            return self._poll_fault(callback, wait, wait.polled)
        who, group = f"{callback} waits in {wait.what}", callback.group
        name = self.called.get(wait.client) if wait.client else None
        name = None if name in self.doubled else name  # another server may answer
        shut_out = [server.what for server in self.servers if name and server[1:] == (name, group)]
        if wait.client and self.clients.get(wait.client) == group:
            shut_out.append("the client")
        if shut_out and group is not None and group.is_exclusive:
            what = "answer" if "the client" in shut_out else f"server {shut_out[0]}"
            needs = f"{who}, whose {what} needs {group}, which {callback.method} holds until it returns"
            apart = f"make {callback.method} with {_OWN}"
            if not wait.holds_thread:
                return f"{needs}: {apart}"
            return f"{needs}: {_later(wait)}; or {apart}{'' if wait.spins else f', and {_POOL}'}"
        if self.is_single and wait.holds_thread and not wait.spins:
            needs = f"{who}, which needs a thread that spins, and the only one is in {callback.method}"
            return f"{needs}: {_later(wait) if wait.client else 'let a timer call back at that rate'}; or {_POOL}"
        return ""

    def _waits(self, method: str, is_certain: bool, seen: set[str]) -> Iterator[_Wait]:
        """Yield the waits of a method, and those of the methods that it calls."""
        function = self.methods.get(method)
        if function is None or method in seen:
            return
        seen.add(method)
        scope = _Scope(function, futures_of(function, self.clients), _made_by(function, "create_rate") | self.rates)
        for node, parents in walk(function, into_functions=False):
            is_sure = is_certain and not any(isinstance(p, _BRANCHES) for p in parents)
            match node:
                case ast.Call(func=ast.Attribute(value=ast.Name("self"), attr=name)) if name in self.methods:
                    if not isinstance(self.methods[name], ast.AsyncFunctionDef) or isinstance(parents[-1], ast.Await):
                        yield from self._waits(name, is_sure, seen)
                case ast.Call(func=ast.Attribute(value=ast.Attribute(value=ast.Name("self"), attr=name), attr=verb)):
                    yield from self._attribute_waits(node, name, verb, scope, is_sure, parents[-1])
                case ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="sleep")) if name in scope.rates:
                    yield _Wait(f"{name}.sleep", node.lineno, "", True, False, is_sure)
                case ast.Call(func=spin) if ast.unparse(spin) in SPINS:
                    clients = (scope.futures[dotted(a)] for a in node.args if dotted(a) in scope.futures)
                    yield _Wait(ast.unparse(spin), node.lineno, next(clients, ""), True, True, is_sure)
                case ast.While():
                    yield from self._loop_waits(node, scope, is_sure)
                case ast.Await(value=awaited) if (future := dotted(awaited)) in scope.futures:
                    yield _Wait(f"await {future}", node.lineno, scope.futures[future], False, False, is_sure)

    def _attribute_waits(
        self, call: ast.Call, name: str, verb: str, scope: _Scope, is_sure: bool, above: ast.AST
    ) -> Iterator[_Wait]:
        """Yield the wait of `self.name.verb(...)`, if it is one."""
        if name in self.clients and verb in ("call", "send_goal"):
            yield _Wait(f"self.{name}.{verb}", call.lineno, name, True, False, is_sure)
        elif name in self.events and verb == "wait" and not (call.args or call.keywords):
            poll = Polled(f"self.{name}.wait", frozenset({name}), gives_up=False)
            yield _Wait(poll.text, call.lineno, "", True, False, False, poll)
        elif f"self.{name}" in scope.rates and verb == "sleep":
            yield _Wait(f"self.{name}.sleep", call.lineno, "", True, False, is_sure)
        elif name in self.clients and verb == "call_async" and isinstance(above, ast.Await):
            yield _Wait(f"await self.{name}.call_async", call.lineno, name, False, False, is_sure)

    def _loop_waits(self, loop: ast.While, scope: _Scope, is_sure: bool) -> Iterator[_Wait]:
        """Yield the wait of a loop that polls a future or attributes."""
        spins = any(_calls(inner) in SPINS for inner in nodes_in(loop))
        for owner in polled_futures(loop.test):
            if (future := dotted(owner)) in scope.futures:
                what = f"`while not {future}.done()`"
                yield _Wait(what, loop.lineno, scope.futures[future], True, spins, is_sure)
                return
        poll = None if isinstance(scope.function, ast.AsyncFunctionDef) else polled(loop, self.methods)
        is_of_rate = any(
            isinstance(n, ast.Attribute) and n.attr == "sleep" and dotted(n.value) in scope.rates
            for n in nodes_in(loop)
        )
        if poll is not None and not (self.is_single and is_of_rate):  # the wait for the rate is a finding of its own
            yield _Wait(poll.text, loop.lineno, "", True, spins, False, poll)


def _later(wait: _Wait) -> str:
    """Return the call that does not block, in place of one that does."""
    call = "send_goal_async(goal)" if wait.what.endswith(".send_goal") else "call_async(request)"
    return f"use {call} and add_done_callback(...)"


def _grade(wait: _Wait) -> Grade:
    return "CERTAIN" if wait.is_certain else "IF THIS BRANCH RUNS"


def findings_in(path: Path) -> list[Finding]:
    """Return the findings in a Python file, or in all files below a folder; none for a file that cannot be read."""
    found: list[Finding] = []
    for tree, file in _trees_in(path):
        idle = _idle_loops(tree)
        found += (f for cls in _classes(tree, file) for f in cls.findings() if f.place.line not in idle)
        found += unspun_waits(tree, file)
    return sorted(dict.fromkeys(found), key=lambda f: f.place)


def _idle_loops(tree: ast.Module) -> set[int]:
    """Return the lines of loops that never run: `while not client.wait_for_service:`, whose method is not called."""
    tests = [node.test for node in nodes_in(tree) if isinstance(node, ast.While)]
    negated = {test.lineno for test in tests if isinstance(test, ast.UnaryOp)}
    return negated & {line for line, _ in uncalled_methods(tree)} if negated else set()


def unfollowed_in(path: Path) -> list[Place]:
    """Return the places at which callbacks poll something whose changes the source does not show."""
    found: set[Place] = set()
    for tree, file in _trees_in(path):
        found.update(place for cls in _classes(tree, file) for place in cls.unfollowed())
        found.update(_helper_loops(tree, file))
    return sorted(found)


def _trees_in(path: Path) -> Iterator[tuple[ast.Module, str]]:
    for file in files_in(path):
        with suppress(OSError, SyntaxError, ValueError):
            yield ast.parse(found_text(file)), str(file)


def _helper_loops(tree: ast.Module, file: str) -> Iterator[Place]:
    """Yield the polling loops of classes that are no nodes, whose methods callbacks may call."""
    nodes = set(_BASES)
    keywords = [node for node in nodes_in(tree) if isinstance(node, ast.keyword)]
    in_threads = {last_name(keyword.value) for keyword in keywords if keyword.arg == "target"}
    for definition in tree.body:
        if not isinstance(definition, ast.ClassDef):
            continue
        if not nodes.isdisjoint(map(last_name, definition.bases)):
            nodes.add(definition.name)
            continue
        methods = {item.name: item for item in definition.body if isinstance(item, FunctionNode)}
        for method in (method for name, method in methods.items() if name not in in_threads):
            for loop in (node for node in nodes_in(method) if isinstance(node, ast.While)):
                poll = polled(loop, methods)
                if poll is not None and poll.flags and not poll.gives_up:
                    yield Place(file, loop.lineno)


def files_in(path: Path) -> Iterator[Path]:
    """Yield a file, or the Python files below a folder, without build results and hidden ones; a bounded number."""
    if path.is_file():
        yield path
        return
    number = 0
    for file in sorted(path.rglob("*.py")):
        parts = file.relative_to(path).parts
        if not any(part in _LEFT_OUT or part.startswith(".") for part in parts):
            yield file
            number += 1
        if number >= FILES_BOUND:
            return


def _classes(tree: ast.Module, file: str) -> Iterator[_Class]:
    """Yield the node classes of a file, each with its callbacks, clients and servers."""
    names = {node.id for node in nodes_in(tree) if isinstance(node, ast.Name)}
    names |= {node.attr for node in nodes_in(tree) if isinstance(node, ast.Attribute)}
    imported = [alias for node in nodes_in(tree) if isinstance(node, ast.ImportFrom) for alias in node.names]
    names |= {alias.name for alias in imported if alias.asname in names}
    others = {name for name in names if name.endswith("Executor")} - _OF_ONE_THREAD
    is_single = not others and bool({"spin", "SingleThreadedExecutor"} & names)
    servers = Counter(_name_of(n) for n in nodes_in(tree) if isinstance(n, ast.Call) and last_name(n.func) in _SERVERS)
    doubled = frozenset(name for name, count in servers.items() if count > 1)
    known: dict[str, _Class] = {base: _Class(file, is_single, doubled, written_from_outside(tree)) for base in _BASES}
    for definition in tree.body:
        if isinstance(definition, ast.ClassDef):
            parent = next((known[name] for name in map(last_name, definition.bases) if name in known), None)
            if parent is not None:
                known[definition.name] = _read(definition, parent)
                yield known[definition.name]


def _read(definition: ast.ClassDef, parent: _Class) -> _Class:
    """Read a class, with the members that it inherits from a parent in the same file."""
    own = dict(parent.methods), dict(parent.groups), dict(parent.clients), dict(parent.called), list(parent.servers)
    rates = {name for name in _made_by(definition, "create_rate") if name.startswith("self.")}
    events = {name.removeprefix("self.") for name in _made_by(definition, "Event") if name.startswith("self.")}
    found = _Class(
        parent.file,
        parent.is_single,
        parent.doubled,
        parent.written,
        *own,
        list(parent.callbacks),
        parent.rates | rates,
        parent.events | events,
    )
    found.methods |= {item.name: item for item in definition.body if isinstance(item, FunctionNode)}
    _read_assignments(found, definition)
    for call in nodes_in(definition):
        if isinstance(call, ast.Call) and last_name(call.func) in _CALLBACK_AT:
            _read_callback(found, call)
    return found


def _read_assignments(found: _Class, definition: ast.ClassDef) -> None:
    """Add the groups and clients that a class assigns; groups first, since clients refer to them."""
    assigned = [n for n in nodes_in(definition) if isinstance(n, ast.Assign) and len(n.targets) == 1]
    for node in assigned:
        group = _new_group(node.value, dotted(node.targets[0]))
        if group is not None:
            found.groups[dotted(node.targets[0])] = group
    for node in assigned:
        if isinstance(node.value, ast.Call) and last_name(node.value.func) in ("create_client", "ActionClient"):
            client = dotted(node.targets[0]).removeprefix("self.")
            found.clients[client] = _group_of(node.value, found.groups)
            found.called[client] = _name_of(node.value)


def _read_callback(found: _Class, call: ast.Call) -> None:
    """Add the callback that a call registers, and the server that it creates."""
    maker = last_name(call.func)
    callback = _argument(call, _CALLBACK_AT[maker], "callback", "execute_callback")
    method = dotted(callback).removeprefix("self.") if callback is not None else ""
    if method in found.methods:
        # rclpy runs the bodies of goals outside the group of their action server.
        group = None if maker == "ActionServer" else _group_of(call, found.groups)
        found.callbacks.append(_Callback(method, _KINDS.get(maker, "action"), group))
    if maker in _SERVERS:
        what = "the action server" if maker == "ActionServer" else method or "of that name"
        found.servers.append(_Server(what, _name_of(call), _group_of(call, found.groups)))


def _name_of(call: ast.Call) -> str:
    """Return the name argument of a server or a client, as the code writes it."""
    name = _argument(call, 2 if last_name(call.func).startswith("Action") else 1, "srv_name", "action_name")
    return "" if name is None else ast.unparse(name)


def _group_of(call: ast.Call, groups: dict[str, _Group]) -> _Group | None:
    """Return the callback group of what a call creates; None if it is not known."""
    group = _argument(call, _GROUP_AT.get(last_name(call.func), 99), "callback_group")
    if group is None or (isinstance(group, ast.Constant) and group.value is None):
        return _DEFAULT
    return groups.get(dotted(group)) or _new_group(group, f"line {call.lineno}")


def _new_group(value: ast.expr, name: str) -> _Group | None:
    """Return the group that an expression creates; None for any other expression."""
    if not isinstance(value, ast.Call):
        return None
    kind = last_name(value.func)
    if kind not in ("MutuallyExclusiveCallbackGroup", "ReentrantCallbackGroup"):
        return None
    return _Group(f"callback group {name}", kind == "MutuallyExclusiveCallbackGroup")


def _argument(call: ast.Call, at: int, *names: str) -> ast.expr | None:
    named = next((keyword.value for keyword in call.keywords if keyword.arg in names), None)
    return named if named is not None else call.args[at] if at < len(call.args) else None


def _made_by(tree: ast.AST, maker: str) -> set[str]:
    """Return the names of objects that a function creates, attributes with their `self.`."""
    found = set()
    for node in nodes_in(tree):
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=function)) if last_name(function) == maker:
                found.add(dotted(target))
    return found


def _calls(node: ast.AST) -> str:
    return ast.unparse(node.func) if isinstance(node, ast.Call) else ""
