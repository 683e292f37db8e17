"""Deadlocks that the source of rclpy nodes shows before anything runs: callbacks that wait for what they keep out.

Read is one file at a time, and none is run. What a class registers by `create_timer` and the like are its callbacks; a
callback group is known where it is made or named in the same class. What is not plain to see is passed over.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from graphflow.analysis.deadlock_check import Finding, Grade
from graphflow.analysis.rclpy_flags import Polled, changers, polled, written_from_outside
from graphflow.errors import Place
from graphflow.reading import found_text

FILES_BOUND = 2000
"""Files that are read below a folder."""
_LEFT_OUT = {"build", "install", "log", "node_modules", "venv", "site-packages", "__pycache__"}
_BASES = {"Node", "LifecycleNode"}
_CALLBACK_AT = {"create_timer": 1, "create_subscription": 2, "create_service": 2, "ActionServer": 3}
"""Where the callback is among the arguments of what registers it."""
_GROUP_AT = {"create_timer": 2}
_SERVERS = ("create_service", "ActionServer")
_OF_ONE_THREAD = {"SingleThreadedExecutor", "EventsExecutor", "ThreadPoolExecutor", "ProcessPoolExecutor"}
"""Executors of rclpy's with one thread, and what is none of rclpy's."""
_KINDS = {"create_timer": "timer", "create_subscription": "subscription", "create_service": "service"}
_BRANCHES = (ast.If, ast.For, ast.While, ast.Try, ast.IfExp, ast.Match, ast.ExceptHandler)
_NESTED = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
_SPINS = ("rclpy.spin_until_future_complete", "rclpy.spin_once", "rclpy.spin")
_LOOKS = ("spin_until_future_complete", "spin_once_until_future_complete", "print")
_LATER = "use call_async(request) and add_done_callback(...)"
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
    """None where it is in none, or in one that is not known."""

    def __str__(self) -> str:
        return f"{self.kind} {self.method}"


class _Server(NamedTuple):
    """What answers requests."""

    what: str
    """In words: the method, or `the action server`."""
    name: str
    """The name of the service or action, as it is written."""
    group: _Group | None


class _Wait(NamedTuple):
    """Something that a method waits for."""

    what: str
    """In words: `self.client.call`."""
    syntax: ast.AST
    client: str
    """The attribute that is the client whose answer it is; empty for the tick of a rate."""
    holds_thread: bool
    spins: bool
    is_certain: bool
    polled: Polled | None = None
    """The attributes that a loop only looks at."""


@dataclass
class _Class:
    """A node's class."""

    file: str
    is_single: bool
    """Whether one thread spins it."""
    doubled: frozenset[str] = frozenset()
    """The names of services that several servers in the file have."""
    written: frozenset[str] = frozenset()
    """Attributes that the file assigns on something other than `self`."""
    methods: dict[str, ast.FunctionDef | ast.AsyncFunctionDef] = field(default_factory=dict)
    groups: dict[str, _Group] = field(default_factory=dict)
    clients: dict[str, _Group | None] = field(default_factory=dict)
    asked: dict[str, str] = field(default_factory=dict)
    """The names of the services and actions that clients call, as they are written."""
    servers: list[_Server] = field(default_factory=list)
    callbacks: list[_Callback] = field(default_factory=list)
    rates: set[str] = field(default_factory=set)
    """Attributes, with their `self.`."""
    events: set[str] = field(default_factory=set)
    """Attributes that are a `threading.Event`."""

    def findings(self) -> Iterator[Finding]:
        seen: set[tuple[int, str]] = set()
        for callback in self.callbacks:
            for wait in self._waits(callback.method, True, set()):
                text = self._fault(callback, wait)
                line = getattr(wait.syntax, "lineno", 0)
                if text and (line, callback.method) not in seen:
                    seen.add((line, callback.method))
                    yield Finding(_grade(wait), Place(self.file, line), text)
        for wait in self._waits("__init__", True, set()):
            if wait.holds_thread and not wait.spins:
                line = getattr(wait.syntax, "lineno", 0)
                text = f"__init__ waits in {wait.what}, and nobody spins the node before it is made: {_LATER}"
                yield Finding(_grade(wait), Place(self.file, line), text)

    def unfollowed(self) -> Iterator[Place]:
        """Loops that poll in callbacks, and that may wait for what the source does not show."""
        for callback in self.callbacks:
            for wait in self._waits(callback.method, True, set()):
                if wait.polled is not None and not wait.polled.gives_up and self._changers(wait.polled) is None:
                    yield Place(self.file, getattr(wait.syntax, "lineno", 0))

    def _changers(self, poll: Polled) -> frozenset[str] | None:
        """The methods by which what a loop polls changes; None where that is not known."""
        if not poll.flags or poll.flags & self.written:
            return None
        found = changers(poll.flags, self.methods, frozenset(callback.method for callback in self.callbacks))
        return found.methods if found.is_known else None

    def _poll_fault(self, callback: _Callback, wait: _Wait, poll: Polled) -> str:
        """Why a loop polls for ever; empty if it may end."""
        ways = None if poll.gives_up else self._changers(poll)
        if not ways:
            return ""
        others, group = sorted(ways - {callback.method}), callback.group
        by = [other for other in self.callbacks if other.method in ways]
        what, setters = " and ".join(f"self.{flag}" for flag in sorted(poll.flags)), " and ".join(others)
        one = "s" if len(others) < 2 else ""
        needs = (
            f"{callback} waits in {wait.what}, and {setters or 'only its next run'}, which set{one} {what}, need{one}"
        )
        is_kept_out = ways == {other.method for other in by} and all(other.group == group for other in by)
        later = f"return instead of waiting, and go on in {setters}" if others else "return instead of waiting"
        if is_kept_out and group is not None and group.is_exclusive:
            text = f"{needs} {group}, which {callback.method} holds until it returns: {later}"
        elif self.is_single and not wait.spins:
            text = f"{needs} a thread that spins, and the only one is in {callback.method}: {later}"
        else:
            return ""
        return f"{text}; or make {callback.method} with {_OWN}{'' if wait.spins else f', and {_POOL}'}"

    def _fault(self, callback: _Callback, wait: _Wait) -> str:
        """Why a wait never ends; empty if it may."""
        if wait.polled is not None:
            return self._poll_fault(callback, wait, wait.polled)
        who, group = f"{callback} waits in {wait.what}", callback.group
        asked = self.asked.get(wait.client) if wait.client else None
        asked = None if asked in self.doubled else asked  # another server may answer
        shut_out = [server.what for server in self.servers if asked and server[1:] == (asked, group)]
        if wait.client and self.clients.get(wait.client) == group:
            shut_out.append("the client")
        if shut_out and group is not None and group.is_exclusive:
            what = "answer" if "the client" in shut_out else f"server {shut_out[0]}"
            needs = f"{who}, whose {what} needs {group}, which {callback.method} holds until it returns"
            apart = f"make {callback.method} with {_OWN}"
            if not wait.holds_thread:
                return f"{needs}: {apart}"
            return f"{needs}: {_LATER}; or {apart}{'' if wait.spins else f', and {_POOL}'}"
        if self.is_single and wait.holds_thread and not wait.spins:
            needs = f"{who}, which needs a thread that spins, and the only one is in {callback.method}"
            return f"{needs}: {_LATER if wait.client else 'let a timer call back at that rate'}; or {_POOL}"
        return ""

    def _waits(self, method: str, is_certain: bool, seen: set[str]) -> Iterator[_Wait]:
        """What a method waits for, and those that it calls."""
        function = self.methods.get(method)
        if function is None or method in seen:
            return
        seen.add(method)
        futures = _futures(function, self.clients)
        rates = _made_by(function, "create_rate") | self.rates
        for node, parents in _walk(function):
            is_sure = is_certain and not any(isinstance(p, _BRANCHES) for p in parents)
            match node:
                case ast.Call(func=ast.Attribute(value=ast.Attribute(value=ast.Name("self"), attr=name), attr=verb)):
                    if name in self.clients and verb in ("call", "send_goal"):
                        yield _Wait(f"self.{name}.{verb}", node, name, True, False, is_sure)
                    elif name in self.events and verb == "wait" and not (node.args or node.keywords):
                        poll = Polled(f"self.{name}.wait", frozenset({name}), gives_up=False)
                        yield _Wait(poll.text, node, "", True, False, False, poll)
                    elif f"self.{name}" in rates and verb == "sleep":
                        yield _Wait(f"self.{name}.sleep", node, "", True, False, is_sure)
                    elif name in self.clients and verb == "call_async" and isinstance(parents[-1], ast.Await):
                        yield _Wait(f"await self.{name}.call_async", node, name, False, False, is_sure)
                case ast.Call(func=ast.Attribute(value=ast.Name("self"), attr=name)) if name in self.methods:
                    if not isinstance(self.methods[name], ast.AsyncFunctionDef) or isinstance(parents[-1], ast.Await):
                        yield from self._waits(name, is_sure, seen)
                case ast.Call(func=ast.Attribute(value=ast.Name(id=name), attr="sleep")) if name in rates:
                    yield _Wait(f"{name}.sleep", node, "", True, False, is_sure)
                case ast.Call(func=function_) if ast.unparse(function_) in _SPINS:
                    asked = next((_word(argument) for argument in node.args if _word(argument) in futures), "")
                    yield _Wait(ast.unparse(function_), node, futures.get(asked, ""), True, True, is_sure)
                case ast.While(test=test):
                    asked = next((_word(owner) for owner in _asked(test) if _word(owner) in futures), "")
                    if asked:
                        spins = any(_calls(inner) in _SPINS for inner in ast.walk(node))
                        around = is_certain and not any(isinstance(p, _BRANCHES) for p in parents)
                        yield _Wait(f"`while not {asked}.done()`", node, futures[asked], True, spins, around)
                    elif not isinstance(function, ast.AsyncFunctionDef):
                        yield from self._polls(node, rates)
                case ast.Await(value=awaited) if _word(awaited) in futures:
                    name = futures[_word(awaited)]
                    yield _Wait(f"await {_word(awaited)}", node, name, False, False, is_sure)

    def _polls(self, loop: ast.While, rates: set[str]) -> Iterator[_Wait]:
        """The wait of a loop that looks at attributes again and again."""
        poll = polled(loop, self.methods)
        is_of_rate = any(
            isinstance(n, ast.Attribute) and n.attr == "sleep" and _word(n.value) in rates for n in ast.walk(loop)
        )
        if poll is not None and not (self.is_single and is_of_rate):  # what a rate needs is told anyway
            spins = any(_calls(inner) in _SPINS for inner in ast.walk(loop))
            yield _Wait(poll.text, loop, "", True, spins, False, poll)


def _grade(wait: _Wait) -> Grade:
    return "CERTAIN" if wait.is_certain else "IF THIS BRANCH RUNS"


def findings_in(path: Path) -> list[Finding]:
    """What the source of a Python file, or of all below a folder, shows. Nothing where it cannot be read."""
    found = [finding for cls in _classes_in(path) for finding in cls.findings()]
    return sorted(dict.fromkeys(found), key=lambda f: f.place)


def unfollowed_in(path: Path) -> list[Place]:
    """Where callbacks poll something of which the source does not show how it changes."""
    return sorted({place for cls in _classes_in(path) for place in cls.unfollowed()})


def _classes_in(path: Path) -> Iterator[_Class]:
    for file in files_in(path):
        try:
            tree = ast.parse(found_text(file))
        except (OSError, SyntaxError, ValueError):
            continue
        yield from _classes(tree, str(file))


def files_in(path: Path) -> Iterator[Path]:
    """A file, or the Python files below a folder, but for what is built or hidden; a bounded number."""
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
    """The node classes of a file, each with what it registers."""
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    names |= {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    imported = [alias for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for alias in node.names]
    names |= {alias.name for alias in imported if alias.asname in names}
    others = {name for name in names if name.endswith("Executor")} - _OF_ONE_THREAD
    is_single = not others and bool({"spin", "SingleThreadedExecutor"} & names)
    servers = Counter(_name_of(n) for n in ast.walk(tree) if isinstance(n, ast.Call) and _last(n.func) in _SERVERS)
    doubled = frozenset(name for name, count in servers.items() if count > 1)
    known: dict[str, _Class] = {base: _Class(file, is_single, doubled, written_from_outside(tree)) for base in _BASES}
    for definition in tree.body:
        if isinstance(definition, ast.ClassDef):
            parent = next((known[name] for name in map(_last, definition.bases) if name in known), None)
            if parent is not None:
                known[definition.name] = _read(definition, parent)
                yield known[definition.name]


def _read(definition: ast.ClassDef, parent: _Class) -> _Class:
    """A class, with what it has from a parent in the same file."""
    own = dict(parent.methods), dict(parent.groups), dict(parent.clients), dict(parent.asked), list(parent.servers)
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
    for item in definition.body:
        if isinstance(item, (ast.FunctionDef, ast.AsyncFunctionDef)):
            found.methods[item.name] = item
    assigned = [n for n in ast.walk(definition) if isinstance(n, ast.Assign) and len(n.targets) == 1]
    for node in assigned:
        group = _made(node.value, _word(node.targets[0]))
        if group is not None:
            found.groups[_word(node.targets[0])] = group
    for node in assigned:
        if isinstance(node.value, ast.Call) and _last(node.value.func) in ("create_client", "ActionClient"):
            client = _word(node.targets[0]).removeprefix("self.")
            found.clients[client] = _group_of(node.value, found.groups)
            found.asked[client] = _name_of(node.value)
    for call in ast.walk(definition):
        if not isinstance(call, ast.Call) or _last(call.func) not in _CALLBACK_AT:
            continue
        maker = _last(call.func)
        callback = _argument(call, _CALLBACK_AT[maker], "callback", "execute_callback")
        method = _word(callback).removeprefix("self.") if callback is not None else ""
        if method in found.methods:
            group = None if maker == "ActionServer" else _group_of(call, found.groups)  # bodies of goals are in none
            found.callbacks.append(_Callback(method, _KINDS.get(maker, "action"), group))
        if maker in _SERVERS:
            what = "the action server" if maker == "ActionServer" else method or "of that name"
            found.servers.append(_Server(what, _name_of(call), _group_of(call, found.groups)))
    return found


def _name_of(call: ast.Call) -> str:
    """The name that a server or a client is made with, as it is written."""
    given = _argument(call, 2 if _last(call.func).startswith("Action") else 1, "srv_name", "action_name")
    return "" if given is None else ast.unparse(given)


def _group_of(call: ast.Call, groups: dict[str, _Group]) -> _Group | None:
    given = _argument(call, _GROUP_AT.get(_last(call.func), 99), "callback_group")
    if given is None or (isinstance(given, ast.Constant) and given.value is None):
        return _DEFAULT
    return groups.get(_word(given)) or _made(given, f"line {call.lineno}")


def _made(value: ast.expr, name: str) -> _Group | None:
    """The group that an expression makes."""
    if not isinstance(value, ast.Call):
        return None
    kind = _last(value.func)
    if kind not in ("MutuallyExclusiveCallbackGroup", "ReentrantCallbackGroup"):
        return None
    return _Group(f"callback group {name}", kind == "MutuallyExclusiveCallbackGroup")


def _argument(call: ast.Call, at: int, *names: str) -> ast.expr | None:
    named = next((keyword.value for keyword in call.keywords if keyword.arg in names), None)
    return named if named is not None else call.args[at] if at < len(call.args) else None


def _futures(function: ast.AST, clients: dict[str, _Group | None]) -> dict[str, str]:
    """The names of futures that a function gets from clients, each with the client."""
    found = {}
    for node in ast.walk(function):
        match node:
            case ast.Assign(
                targets=[target],
                value=ast.Call(func=ast.Attribute(value=ast.Attribute(value=ast.Name("self"), attr=name), attr=verb)),
            ) if name in clients and verb in ("call_async", "send_goal_async"):
                if not _is_known_elsewhere(_word(target), function):
                    found[_word(target)] = name
    return found


def _is_known_elsewhere(future: str, function: ast.AST) -> bool:
    """Whether a function gives a future to others, who may end it, or ends it itself."""
    parents = {child: node for node in ast.walk(function) for child in ast.iter_child_nodes(node)}
    inner = {n for top in ast.walk(function) if isinstance(top, _NESTED) and top is not function for n in ast.walk(top)}
    for node in parents:
        if not (isinstance(node, ast.Name | ast.Attribute) and _word(node) == future):
            continue
        if not isinstance(node.ctx, ast.Load):
            continue
        if node in inner:
            return True  # which runs at any time
        match parents[node]:
            case ast.Attribute(attr=attr) if attr not in ("cancel", "set_result", "set_exception"):
                continue
            case ast.Await() | ast.Expr():
                continue
            case ast.Call(func=called) if ast.unparse(called) in _SPINS or _last(called) in _LOOKS:
                continue
        return True
    return False


def _made_by(tree: ast.AST, maker: str) -> set[str]:
    """Objects that a function makes, such as rates: names, and attributes with their `self.`."""
    found = set()
    for node in ast.walk(tree):
        match node:
            case ast.Assign(targets=[target], value=ast.Call(func=made)) if _last(made) == maker:
                found.add(_word(target))
    return found


def _walk(top: ast.AST) -> Iterator[tuple[ast.AST, Sequence[ast.AST]]]:
    """What a function does itself, with what encloses it; not what functions inside it do."""
    todo: list[tuple[ast.AST, tuple[ast.AST, ...]]] = [(top, ())]
    while todo:
        node, parents = todo.pop()
        if parents:
            yield node, parents
        if not parents or not isinstance(node, _NESTED):
            todo += [(child, (*parents, node)) for child in reversed([*ast.iter_child_nodes(node)])]


def _asked(test: ast.expr) -> Iterator[ast.expr]:
    """What a condition asks whether it is done."""
    for node in ast.walk(test):
        match node:
            case ast.UnaryOp(op=ast.Not(), operand=ast.Call(func=ast.Attribute(value=owner, attr="done"))):
                yield owner


def _calls(node: ast.AST) -> str:
    return ast.unparse(node.func) if isinstance(node, ast.Call) else ""


def _word(expression: ast.expr) -> str:
    """A name, or an attribute of one, as it is written; empty for anything else."""
    return ast.unparse(expression) if isinstance(expression, (ast.Name, ast.Attribute)) else ""


def _last(expression: ast.expr) -> str:
    """`spin` of `rclpy.spin`."""
    return _word(expression).rpartition(".")[2]
