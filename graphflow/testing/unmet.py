"""Possible causes of a test's failure: messages in transit, time, and topics and services that no node has."""

from __future__ import annotations

import ast
import asyncio
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from graphflow.analysis.frames import awaited, code_of
from graphflow.analysis.syntax import nodes_in, syntax_of
from graphflow.analysis.user_code import parts_of, short_place
from graphflow.deadlock.startup_waits import place_of
from graphflow.errors import Place
from graphflow.executor import clock as executor_clock
from graphflow.machines.lifecycle import LifecycleState
from graphflow.machines.near_topics import is_misspelt
from graphflow.names import did_you_mean, is_hidden
from graphflow.runtime import callables
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.endpoints.timer import Timer
from graphflow.runtime.managed.lifecycle_node import LifecycleNode
from graphflow.runtime.mistakes.source.shadowing import definition_of
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import NodeCore, core_of
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from graphflow.testing.graph import Graph

_ACTION = "/_action/"
"""The part between an action's name and the names of its services."""
_REAL_TIMES = ("time.time", "time.monotonic", "time.perf_counter", "datetime.now")
"""Calls that read a clock which no test moves."""


def arrivals(graph: Graph) -> dict[tuple[str, str], int]:
    """Return the numbers of messages that have been taken so far: by taps, and by handlers with their nodes."""
    found = {(topic, ""): len(tap) for topic, tap in graph.taps}
    for node in graph.nodes:
        if node is not graph.tester and node.is_running:
            counts = [(end.name, end.statistics()) for end in node.endpoints if isinstance(end, TopicSubscription)]
            found |= {(name, node.full_name): count["received"] - count["waiting"] for name, count in counts}
    return found


def _afterwards(
    before: Mapping[tuple[str, str], int], now: Mapping[tuple[str, str], int]
) -> tuple[list[str], list[str]]:
    """Return a sentence for each tap, and for each handler, that has taken messages after the test."""
    found: tuple[list[str], list[str]] = [], []
    for (topic, node), number in now.items():
        if late := number - before.get((topic, node), number):
            came = f"{_messages(late)} of {topic} arrived{f' at {node}' if node else ''} after the test had ended"
            found[bool(node)].append(f"{came}: await graph.settle() before inspecting {'it' if node else 'them'}")
    return found


async def unmet(
    graph: Graph, before: Mapping[tuple[str, str], int] | None = None, test: Callable[..., object] | None = None
) -> list[str]:
    """Return a sentence for each unmet wait. Call it after the failure: messages in transit arrive meanwhile.

    Args:
        before: The arrivals as the test failed; those of now if None.
        test: The test's function, if it is known.
    """
    cores = [core_of(node) for node in graph.nodes if node is not graph.tester and node.is_running]
    before = arrivals(graph) if before is None else before
    has_stood_still = not graph.clock.monotonic_ns() and any(map(_waits_for_time, cores))
    found = [*_sleepers(cores), *unserved(graph)]
    await graph.settle()
    at_taps, at_nodes = _afterwards(before, arrivals(graph))
    found += at_taps
    found += _late(graph)
    found += _strangers(graph, cores)
    found += _inactive(graph)
    found += _dropped(graph)
    if has_stood_still:
        found.append(_still(test))
    found += at_nodes if not found else []
    if not found and any(not tap for _, tap in graph.taps):
        found += _unfed(graph, cores)
    return found or [*_real_times(cores)]


def _still(test: Callable[..., object] | None) -> str:
    """Return the sentence for a clock that was never advanced: the test may wait in real time instead."""
    code = callables.code_of(test)
    if code is not None:
        lines = {line for *_, line in code.co_lines()}
        with suppress(OSError, SyntaxError, ValueError):  # its source is not available
            for node in nodes_in(syntax_of(code.co_filename).module):
                match node:
                    case ast.Call(func=ast.Attribute(value=ast.Name("asyncio"), attr="sleep"), args=[span]):
                        if node.lineno in lines:
                            text = "asyncio.sleep waits in real time, and the test's clock stood still"
                            way = f"write await graph.clock.advance({ast.unparse(span)})"
                            return f"{short_place(code.co_filename, node.lineno)}: {text}; {way}"
    return "the test's clock stood still, and something waits for time: await graph.clock.advance(1.0)"


def _real_times(cores: list[NodeCore]) -> Iterator[str]:
    """Find the lines of nodes that read the real time."""
    for cls in dict.fromkeys(type(core.instance) for core in cores):
        if (found := definition_of(cls)) is None:
            continue
        definition, file = found
        for node in nodes_in(definition):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in _REAL_TIMES:
                text = "reads the real time, and a test moves the graph's: write self.clock.now()"
                yield f"{Place(file, node.lineno)} {text}"


def _unfed(graph: Graph, cores: list[NodeCore]) -> Iterator[str]:
    """Find topics with subscriptions and no publisher, without which nodes may have nothing to publish."""
    published = {e.name for node in graph.nodes for e in core_of(node).endpoints if e.kind is Kind.PUBLISHER}
    for core in cores:
        for name in sorted({e.name for e in core.endpoints if e.kind is Kind.SUBSCRIPTION} - published):
            if not is_hidden(name):
                yield f"{core.full_name} listens to {name}, to which neither the test nor its nodes publish"


def _tasks(core: NodeCore) -> Iterator[Any]:
    """List a node's tasks and the runs of its handlers."""
    yield from core.tasks
    for runner in core.runners:
        yield from runner.active


def _waits_for_time(core: NodeCore) -> bool:
    """Whether a node has timers, or waits by its clock."""
    if any(isinstance(part, Timer) for part in core.parts):
        return True
    waits = [code_of(part) for task in _tasks(core) for part in awaited(task.get_coro())]
    return any(code is not None and code.co_filename == executor_clock.__file__ for code in waits)


def _sleepers(cores: list[NodeCore]) -> Iterator[str]:
    """Find tasks and handlers that wait in real time."""
    for core in cores:
        for task in _tasks(core):
            if any(code_of(part) is asyncio.sleep.__code__ for part in awaited(task.get_coro())):
                where = place_of(task)
                yield (
                    f"{core.full_name} waits{where and ' ' + where} for real time, but a test does not: write "
                    "await self.clock.sleep(...) instead of asyncio.sleep"
                )


def unserved(graph: Graph) -> Iterator[str]:
    """Find services and actions that nodes, or the test itself, wait for, and that no node offers."""
    cores = [core_of(node) for node in graph.nodes if node.is_running]
    offered = {
        e.name.partition(_ACTION)[0]: e.name.startswith(f"{core.full_name}/")
        for core in cores
        for e in core.endpoints
        if e.kind is Kind.SERVICE
    }
    known = [name for name, is_nodes_own in offered.items() if not is_nodes_own]
    for core in cores:
        ledger = core.context.ledger
        waits = [opening.service for opening in ledger.openings.values()]
        for name in sorted({wait.partition(_ACTION)[0] for wait in waits} - offered.keys()):
            hint = did_you_mean(name, known, hidden=offered)
            who = "the test" if graph.tester is not None and core is core_of(graph.tester) else core.full_name
            yield f"{who} waits for {name}, which no node of the test offers{hint}"


def _late(graph: Graph) -> Iterator[str]:
    """Find taps that were opened, and nodes that were started, after messages had been published."""
    for topic, tap in graph.taps:
        if tap.missed:
            yield (
                f"{_messages(tap.missed)} of {topic} arrived before graph.tap, which collects later ones: "
                "move it before the code that causes them"
            )
    for publisher, count, name in graph.unheard:
        yield f"the test published {_messages(count)} on {publisher.name} before {name} listened: start the node first"


def _inactive(graph: Graph) -> Iterator[str]:
    """Find lifecycle nodes that do not work yet."""
    steps = {LifecycleState.UNCONFIGURED: ("configure", "activate"), LifecycleState.INACTIVE: ("activate",)}
    for node in graph.nodes:
        if isinstance(node, LifecycleNode) and node.is_running and node.lifecycle_state in steps:
            ways = " and ".join(f"await node.trigger_{step}()" for step in steps[node.lifecycle_state])
            yield f"{node.full_name} is {node.lifecycle_state.name.lower()}, and its handlers do not run: {ways}"


def _dropped(graph: Graph) -> Iterator[str]:
    """Find subscriptions whose queues were too short for what the test sent at once."""
    for node in graph.nodes:
        for endpoint in node.endpoints if node.is_running else ():
            if isinstance(endpoint, TopicSubscription) and endpoint.dropped and node is not graph.tester:
                lost, depth = _messages(endpoint.dropped), endpoint.qos.depth
                text = f"{node.full_name} lost {lost} of {endpoint.name}: its queue holds {depth}"
                yield f"{text}; await graph.settle() after each message, or a longer depth"


def unstarted(graph: Graph, error: BaseException) -> Iterator[str]:
    """Find nodes among the variables of a failing test that were made and not started."""
    seen = {id(node) for node in graph.nodes}
    for part in parts_of(error.__traceback__):
        for name, thing in part.tb_frame.f_locals.items():
            # By its real class: `isinstance` believes `__class__`, which a mock sets.
            if issubclass(type(thing), Node) and name != "self" and id(thing) not in seen:
                seen.add(id(thing))
                core = vars(thing).get("_core")
                if isinstance(core, NodeCore) and not core.has_started:
                    yield f"{name} is not started: await graph.start({name})"


def _messages(count: int) -> str:
    return f"{count} message{'s' if count > 1 else ''}"


def _strangers(graph: Graph, cores: list[NodeCore]) -> Iterator[str]:
    """Find topics that only the test itself publishes or subscribes to."""
    if graph.tester is None or len(cores) < len(graph.nodes) - 1:
        return  # nodes with these topics may have ended
    tester = graph.tester
    for kind, other, verb, done in (
        (Kind.SUBSCRIPTION, Kind.PUBLISHER, "publishes", "taps"),
        (Kind.PUBLISHER, Kind.SUBSCRIPTION, "listens to", "publishes"),
    ):
        known = {e.name for core in cores for e in core.endpoints if e.kind is other} - _OF_EVERY_NODE
        own = {e.name for e in tester.endpoints if e.kind is other}
        for name in sorted({e.name for e in tester.endpoints if e.kind is kind} - known - own - _OF_EVERY_NODE):
            yield f"no node {verb} {name}, which the test {done}{did_you_mean(name, known)}"


def misspelt_taps(graph: Graph) -> list[str]:
    """Return a sentence for each tap without messages whose topic no node publishes, but one of a like name."""
    cores = [core_of(node) for node in graph.nodes if node is not graph.tester and node.is_running]
    empty = {topic for topic, tap in graph.taps if not tap and not tap.missed}
    found = []
    if not empty or len(cores) < len(graph.nodes) - 1:
        return []  # nodes with these topics may have ended
    known = {e.name for core in cores for e in core.endpoints if e.kind is Kind.PUBLISHER}
    for topic in sorted(empty - known):
        meant = next((name for name in sorted(known) if is_misspelt(topic, name)), None)
        if meant is not None:
            found.append(f"no node publishes {topic}, which the test taps; did you mean {meant}?")
    return found


_OF_EVERY_NODE = {"/rosout", "/parameter_events"}
