"""Plans: resolved graph files, with everything that would run."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Literal

from graphflow.console.subjects import Subject
from graphflow.errors import NOWHERE, GraphFileError, Place, Problem
from graphflow.interface import CALL_TIMEOUT, DeadlockPolicy, GroupChange
from graphflow.machines.regrouping import Regrouping
from graphflow.machines.restarts import BACKOFF, Backoff
from graphflow.names import Remap, did_you_mean

StepKind = Literal["call", "set", "goal", "wait", "delay", "log", "shutdown"]
"""Kinds of steps: a service call, parameters, a goal until its end, waits for a name or a time, a message, the end."""


@dataclass(frozen=True, slots=True)
class Setting:
    """A parameter value and its place."""

    value: Any
    place: Place
    is_optional: bool = False
    """Whether nodes without such a parameter ignore it, as it is set for many nodes at once."""
    is_unchecked: bool = False
    """Whether no node need have such a parameter."""


@dataclass(frozen=True, slots=True)
class Rule:
    """A remap rule and its place."""

    match: str
    replacement: str
    place: Place
    is_optional: bool = False
    """Whether nodes without such a name ignore it, as it is set for many nodes at once."""
    is_unchecked: bool = False
    """Whether no node need have such a name."""

    def remap(self) -> Remap:
        """Return the rule without flags, for a resolver."""
        return Remap(self.match, self.replacement, source=str(self.place))


@dataclass(frozen=True, slots=True)
class PlannedGroup:
    """A concurrency group of a node, with the places of its handlers."""

    change: GroupChange
    place: Place
    handler_places: dict[str, Place] = field(default_factory=dict)

    def __str__(self) -> str:
        change = self.change
        words = [", ".join(change.handlers)] if change.handlers else []
        if change.sets_limit:
            words.append(f"limit {'none' if change.limit is None else change.limit}")
        if change.when_full is not None:
            words.append(f"when_full {change.when_full}")
        if change.thread is not None:
            words.append("in threads" if change.thread else "on the loop")
        return "; ".join(words)


@dataclass(frozen=True, slots=True)
class PlannedNode:
    """A node as it would run."""

    name: str
    """Full name."""
    class_path: str
    place: Place
    class_place: Place
    params: dict[str, Setting] = field(default_factory=dict)
    remaps: tuple[Rule, ...] = ()
    process: str = ""
    """Name of the process, which nodes may share; empty for a process of its own."""
    env: dict[str, str] = field(default_factory=dict)
    after: dict[str, str] = field(default_factory=dict)
    """Predecessors: full names of nodes or names of steps, each with its condition, `ready`, `exited` or `done`."""
    concurrency: dict[str, PlannedGroup] = field(default_factory=dict)
    """Changes of the groups that the class declares, by group name."""
    command: tuple[str, ...] = ()
    """The command line of a foreign program, in place of a class."""
    executable: str = ""
    """Package and executable of a program that takes ROS 2's arguments: name, remaps and parameters."""
    keeps_names: bool = False
    """Whether the nodes of such a program keep the names in its code."""
    params_files: tuple[str, ...] = ()
    """Parameter files that such a program reads itself, as only it knows the names of its nodes."""
    restart: Backoff = BACKOFF
    on_exit: str = "ignore"
    critical: bool = False
    """Whether the graph shuts down when it fails."""
    log_level: str = ""
    lifecycle: str = ""
    """The state to which a lifecycle node is brought before it counts as ready; empty for none."""
    lifecycle_place: Place = NOWHERE
    is_debugged: bool = False
    """Whether its process waits for a debugger."""

    @property
    def what(self) -> str:
        """The class, the executable of a package, or the command line, for messages."""
        return self.class_path or self.executable or shlex.join(self.command)

    def to_json(self) -> dict[str, Any]:
        """Return the node as JSON, which `node_from_json` reads."""
        return asdict(self)

    def with_threads(self, handlers: Sequence[str]) -> PlannedNode:
        """Return the node with some handlers in threads."""
        groups = self.regrouping("").in_threads(handlers).groups
        planned = {
            name: self.concurrency.get(name, PlannedGroup(change, self.place)) for name, change in groups.items()
        }
        return replace(self, concurrency={name: replace(group, change=groups[name]) for name, group in planned.items()})

    def regrouping(self, file: str) -> Regrouping:
        """Return the graph file's changes of the node's groups, and their place.

        Args:
            file: The graph's own file, which may include the node's file.
        """
        groups = {name: group.change for name, group in self.concurrency.items()}
        if self.place.file == file:
            return Regrouping(groups, file, "nodes", self.place.line)
        return Regrouping(groups, file, "override")


@dataclass(frozen=True, slots=True)
class PlannedStep:
    """A step of the graph, done once."""

    name: str
    do: StepKind
    target: str
    """Full name of the service, node or action, or of the name waited for; the text of a `log` or `shutdown`."""
    place: Place
    target_place: Place
    request_place: Place
    request: dict[str, Any] = field(default_factory=dict)
    field_places: dict[str, Place] = field(default_factory=dict)
    """Places of the fields of the request."""
    type: str | None = None
    after: dict[str, str] = field(default_factory=dict)
    timeout: float = 10.0


@dataclass(frozen=True, slots=True)
class Plan:
    """A resolved graph file: frozen, complete, printable, and convertible to JSON and back."""

    name: str
    file: str
    root: str
    """The folder from which its classes are imported."""
    nodes: tuple[PlannedNode, ...]
    steps: tuple[PlannedStep, ...] = ()
    args: dict[str, Any] = field(default_factory=dict)
    domain: int | None = None
    deadlock: DeadlockPolicy = "raise"
    call_timeout: float | None = CALL_TIMEOUT
    """Default timeout of calls in seconds; None for no limit."""
    strategy: str = "one_for_one"
    """The restart strategy: which processes restart when one fails, `one_for_one`, `rest_for_one` or `one_for_all`."""
    allow_control: bool = False
    """Whether nodes may be loaded and unloaded over the network."""
    console: dict[str, Any] | None = None
    """The windows and panes of the console at its start, as `console.section` reads them."""
    panes: tuple[Subject, ...] = ()
    """The subjects of these panes; only for checks, and not part of the JSON."""
    remarks: tuple[str, ...] = ()
    """Remarks, each with its place: oddities of the files, and settings that give others access."""

    def only(self, names: Iterable[str]) -> Plan:
        """Return the part of the graph with some nodes and all their predecessors.

        Raises:
            GraphFileError: A node does not exist.
        """
        items: list[PlannedNode | PlannedStep] = [*self.nodes, *self.steps]
        known = {item.name: item.after for item in items}
        todo = [name if name.startswith("/") else f"/{name}" for name in names]
        for name in todo:
            if name not in known:
                text = f"the graph has no node {name}{did_you_mean(name, known)}"
                raise GraphFileError([Problem(Place("command line"), text)])
        needed: set[str] = set()
        while todo:
            name = todo.pop()
            if name not in needed:
                needed.add(name)
                todo += known[name]
        nodes = tuple(node for node in self.nodes if node.name in needed)
        return replace(self, nodes=nodes, steps=tuple(step for step in self.steps if step.name in needed))

    def classes(self) -> list[str]:
        """Return the classes of the nodes, each once; foreign programs have none."""
        return sorted({node.class_path for node in self.nodes if not node.command})

    def processes(self) -> dict[str, list[PlannedNode]]:
        """Return the nodes by process, in the order of the file; a process of one node has the node's name."""
        found: dict[str, list[PlannedNode]] = {}
        for node in self.nodes:
            found.setdefault(node.process or node.name, []).append(node)
        return found

    def to_json(self) -> dict[str, Any]:
        """Return the plan as JSON, which `from_json` reads."""
        return {key: value for key, value in asdict(self).items() if key != "panes"}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Plan:
        """Read a plan from JSON."""
        return cls(
            **{k: v for k, v in data.items() if k not in ("nodes", "steps", "remarks")},
            nodes=tuple(node_from_json(n) for n in data["nodes"]),
            steps=tuple(_step(s) for s in data["steps"]),
            remarks=tuple(data["remarks"]),
        )

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def lines(self) -> Iterable[str]:
        """Yield the plan as lines for a reader, with the place of every setting."""
        yield f"graph {self.name}  ({self.file}; classes from {self.root})"
        if self.domain is not None:
            yield f"domain {self.domain}"
        if self.deadlock != "raise":
            yield f"deadlock {self.deadlock}"
        if self.call_timeout != CALL_TIMEOUT:
            yield f"call_timeout {'never' if self.call_timeout is None else self.call_timeout}"
        if self.allow_control:
            yield "net allow_control"
        if self.strategy != "one_for_one":
            yield f"strategy {self.strategy}"
        for name, value in self.args.items():
            yield f"  {name}:={value}"
        for node in self.nodes:
            yield from _node_lines(node)
        yield from self.remarks
        for step in self.steps:
            yield f"step {step.name}"
            yield from _after_line(step.after)
            sent = "" if step.do in ("wait", "delay", "log", "shutdown") else step.request
            yield f"  {step.do:8} {step.target} {sent}".rstrip()


def _node_lines(node: PlannedNode) -> Iterator[str]:
    yield node.name
    yield f"  class    {node.class_path}" if node.class_path else f"  command  {shlex.join(node.command)}"
    if node.process:
        yield f"  process  {node.process}"
    yield from _after_line(node.after)
    yield from _run_lines(node)
    for name, setting in node.params.items():
        yield f"  param    {name} = {setting.value!r}  # {setting.place}"
    for rule in node.remaps:
        yield f"  remap    {rule.match} -> {rule.replacement}  # {rule.place}"
    for name, group in node.concurrency.items():
        yield f"  group    {name}: {group}  # {group.place}"
    for name, value in node.env.items():
        yield f"  env      {name}={value}"


def _run_lines(node: PlannedNode) -> Iterator[str]:
    if node.restart != BACKOFF:
        yield f"  restart  {node.restart}"
    if node.on_exit != "ignore":
        yield f"  on_exit  {node.on_exit}"
    if node.critical:
        yield "  critical"
    if node.keeps_names:
        yield "  names    as its code has them"
    for file in node.params_files:
        yield f"  params   of {file}"
    if node.log_level:
        yield f"  logs     from {node.log_level}"
    if node.lifecycle:
        yield f"  becomes  {node.lifecycle}"


def _after_line(after: Mapping[str, str]) -> Iterator[str]:
    usual = {True: "ready", False: "done"}  # for nodes, whose names begin with a slash, and for steps
    names = [n if word == usual[n.startswith("/")] else f"{n} ({word})" for n, word in after.items()]
    if names:
        yield f"  after    {', '.join(names)}"


_PLAIN = (
    "name",
    "class_path",
    "process",
    "env",
    "after",
    "on_exit",
    "critical",
    "log_level",
    "lifecycle",
    "is_debugged",
    "executable",
    "keeps_names",
)


def node_from_json(data: dict[str, Any]) -> PlannedNode:
    """Read a node from JSON."""
    return PlannedNode(
        **{k: data[k] for k in _PLAIN},
        place=Place(*data["place"]),
        class_place=Place(*data["class_place"]),
        lifecycle_place=Place(*data["lifecycle_place"]),
        params={k: Setting(**{**s, "place": Place(*s["place"])}) for k, s in data["params"].items()},
        remaps=tuple(Rule(**{**rule, "place": Place(*rule["place"])}) for rule in data["remaps"]),
        command=tuple(data["command"]),
        params_files=tuple(data["params_files"]),
        restart=Backoff(**data["restart"]),
        concurrency={name: _group(g) for name, g in data["concurrency"].items()},
    )


def _group(data: dict[str, Any]) -> PlannedGroup:
    places = {name: Place(*place) for name, place in data["handler_places"].items()}
    return PlannedGroup(GroupChange.from_json(data["change"]), Place(*data["place"]), places)


def _step(data: dict[str, Any]) -> PlannedStep:
    places = {k: Place(*data[k]) for k in ("place", "target_place", "request_place")}
    fields = {name: Place(*place) for name, place in data["field_places"].items()}
    return PlannedStep(**{**data, **places, "field_places": fields})
