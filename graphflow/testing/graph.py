"""A graph for one test: nodes on an in-memory network under a manual clock."""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections.abc import Coroutine, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from graphflow.interface import DeadlockPolicy
from graphflow.msgs.base import Action, Feedback, Goal, Message, Request, Response, Result, Service
from graphflow.names import Remap, did_you_mean
from graphflow.qos import Durability, Qos
from graphflow.runtime.actions.client import GoalClient
from graphflow.runtime.context import Context
from graphflow.runtime.endpoints.publishers import TopicPublisher
from graphflow.runtime.mistakes.rclpy_words import AttributeHints
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.runtime.node_options import NodeOptions, make_within
from graphflow.testing.clock import ManualClock, settle
from graphflow.testing.forgotten import awaited
from graphflow.testing.outside import outside
from graphflow.transport.memory import Network
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from graphflow.testing.graph_file import PlanRun

logger = logging.getLogger("graphflow")

M = TypeVar("M", bound=Message)
N = TypeVar("N", bound=Node)


class Tap(AttributeHints, Generic[M]):
    """The messages published on a topic since the tap was opened; a sequence that compares equal to a list."""

    def __init__(self, type_: type[M], topic: str, messages: list[M]) -> None:
        self._type, self._topic = type_, topic
        self.messages = messages
        self.missed = 0
        """Messages published before the tap was opened."""

    def __iter__(self) -> Iterator[M]:
        return iter(self.messages)

    def __len__(self) -> int:
        return len(self.messages)

    def __getitem__(self, index: int) -> M:
        return self.messages[index]

    def __bool__(self) -> bool:
        return bool(self.messages)

    def __eq__(self, other: object) -> bool:
        return self.messages == (other.messages if isinstance(other, Tap) else other)

    def __repr__(self) -> str:
        return f"<Tap {self._topic} {self.messages!r}>"

    @property
    def latest(self) -> M:
        """The newest message. Raises IndexError if there is none."""
        if not self.messages:
            raise IndexError(f"nothing was published on {self._topic} since the tap was opened")
        return self.messages[-1]

    def _hint(self, name: str) -> str:
        if name not in {field.name for field in self._type.SCHEMA.fields}:
            return ""
        return f"a tap is a sequence of messages, which have this attribute: write .latest.{name}, or [0].{name}"


_INSTEAD = {
    **dict.fromkeys(("advance", "sleep", "spin", "spin_once", "step", "wait"), "write await graph.clock.advance(1.0)"),
    **dict.fromkeys(("add", "add_node", "run", "launch"), "write await graph.start(node)"),
    **dict.fromkeys(("publish", "create_publisher"), "write graph.publisher(Type, topic).publish(message)"),
    **dict.fromkeys(
        ("subscribe", "subscription", "listen", "echo", "create_subscription"), "write graph.tap(Type, topic)"
    ),
    **dict.fromkeys(("send_goal", "create_action_client"), "write graph.action_client(Type, name)"),
    "create_client": "write await graph.call(Type, name, request)",
}
"""The methods of a graph for other tools' names of the same."""


class Graph(AttributeHints):
    """The nodes, clock and network of one test. Made by the fixture `graph`."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.network = Network()
        self.nodes: list[Node] = []
        self.deadlock: DeadlockPolicy = "raise"
        """The deadlock policy of nodes started from now on."""
        self._waits_outside = True
        self._contexts: list[Context] = []
        self._names = itertools.count(1)
        self._runs: list[PlanRun] = []
        self.tester: Node | None = None
        """The test's own node, created on first use."""
        self.taps: list[tuple[str, Tap[Any]]] = []
        """The taps, each with the full name of its topic."""
        self.unheard: list[tuple[TopicPublisher[Any], int, str]] = []
        """Publishers of the test: (publisher, messages published before the named node subscribed, node)."""
        self.failed: list[BaseException] = []
        """Failed assertions in nodes, each of which fails the test; a test that expects one clears the list."""
        self.loop: asyncio.AbstractEventLoop | None = None
        """The event loop of the nodes, set by the first one."""

    @property
    def waits_outside(self) -> bool:
        """Whether `settle` and `clock.advance` wait for threads and processes; set it to False if some never end."""
        return self._waits_outside

    @waits_outside.setter
    def waits_outside(self, value: bool) -> None:
        self._waits_outside = value
        if self.loop is not None:
            outside(self.loop).is_awaited = value

    @awaited
    async def start(self, *nodes: Node) -> None:
        """Start nodes, each as if in a process of its own, and let them settle."""
        for node in nodes:
            if any(other.is_running and other.full_name == node.full_name for other in self.nodes):
                text = "two nodes are called %s: parameters, services and tools reach one of them by chance; rename one"
                logger.warning(text, node.full_name)
            early = [p for p in self._publishers(self.tester) if p.published and not p.get_subscription_count()]
            await core_of(node).start(self._context(deadlock=self.deadlock))
            self.nodes.append(node)
            heard = {endpoint.name for endpoint in node.endpoints if endpoint.kind is Kind.SUBSCRIPTION}
            self.unheard += [(p, p.published, node.full_name) for p in early if p.name in heard]
        await settle()

    @awaited
    async def up(self, file: str | Path, **arguments: object) -> Mapping[str, Node]:
        """Start the nodes of a graph file and carry out its steps, as `graphflow up` does, in memory.

        What needs time, such as a step that sends a goal, goes on while the clock advances.

        Args:
            file: The file; a relative path starts at the working directory.
            arguments: The file's arguments, as in `target="carrot1", delay=5.0`.

        Returns:
            The nodes by full name, with those that start later.

        Raises:
            GraphFileError: The file has mistakes.
            GraphflowError: A node could not be made, a step has failed, or a node is a foreign program.
        """
        from graphflow.testing.graph_file import PlanRun, plan_of

        run = PlanRun(plan_of(file, arguments), self._context, self.start, self.failed.append)
        self._runs.append(run)
        run.begin()
        await settle()
        self.raise_failed()
        return run.nodes

    def make(
        self,
        cls: type[N],
        name: str | None = None,
        *,
        namespace: str | None = None,
        remap: Sequence[Remap | str] = (),
        **parameters: object,
    ) -> N:
        """Make a node as a graph file does, even if the class's `__init__(self)` takes no parameters; then `start` it.

        Args:
            parameters: Parameter values by name, including parameters that the constructor declares.

        Raises:
            DeclarationError: Its `__init__` needs more than a name.
            ParameterError: A parameter does not exist, or its value does not fit.
        """
        rules = [rule if isinstance(rule, Remap) else Remap.parse(rule) for rule in remap]
        given = NodeOptions(name, namespace, rules, {key: (value, "graph.make") for key, value in parameters.items()})
        return make_within(cls, given, cls.interface().node_name)

    @awaited
    async def stop(self, node: Node) -> None:
        """Stop one node."""
        await core_of(node).stop()
        await settle()

    def tap(self, type_: type[M], topic: str, qos: Qos | int = 1000) -> Tap[M]:
        """Collect all messages published on `topic` from now on."""
        messages: list[M] = []
        made = self._test_node().create_subscription(type_, topic, messages.append, qos)
        tap = Tap(type_, made.name, messages)
        if made.qos.durability is Durability.VOLATILE:
            known = [p for node in self.nodes for p in self._publishers(node)]
            tap.missed = sum(p.published for p in known if p.name == made.name)
        self.taps.append((made.name, tap))
        return tap

    def publisher(self, type_: type[M], topic: str, qos: Qos | int = 10) -> TopicPublisher[M]:
        """Create a publisher for the test."""
        return self._test_node().create_publisher(type_, topic, qos)

    @awaited
    async def call(
        self, type_: type[Service[Request, Response]], name: str, request: Request, *, timeout: float = 10.0
    ) -> Response:
        """Call a service. Simulated time need not pass for it.

        Raises:
            CallError: As for `ServiceClient.call`.
        """
        client = self._test_node().create_client(type_, name)
        await settle()
        try:
            return await client.call(request, timeout=timeout)
        finally:
            client.close()

    def action_client(
        self, type_: type[Action[Goal, Result, Feedback]], name: str
    ) -> GoalClient[Goal, Result, Feedback]:
        """Create a client with which the test sends goals."""
        return self._test_node().create_action_client(type_, name)

    @awaited
    async def settle(self) -> None:
        """Let everything happen that does not need time to pass."""
        await settle()

    async def close(self) -> None:
        """Stop all nodes; raises a failed node's error that the test did not catch, or a failed assertion."""
        for run in self._runs:
            await run.close()
        for node in reversed(self.nodes):
            await core_of(node).stop()
        for context in self._contexts:
            await context.close()
        for core in map(core_of, self.nodes):
            if core.failure is not None and not core.failure_taken:
                raise core.failure
        self.raise_failed()

    def raise_failed(self) -> None:
        """Raise the first assertion that failed in a node, since its handler has only logged it."""
        failures = [core_of(node).failure for node in self.nodes]  # `close` raises these, or the test has caught them
        failed = [error for error in self.failed if error not in failures]
        self.failed.clear()
        if failed:
            raise failed[0]

    def _noticed(self, error: BaseException) -> None:
        """Record an error that a node has reported if it is meant for the test, as `assert` and `pytest.fail` are."""
        if isinstance(error, AssertionError) or not isinstance(error, (Exception, *_OF_PROGRAMS)):
            self.failed.append(error)

    def _instead_of(self, name: str) -> str:
        known = [word for word in dir(self) if not word.startswith("_")]
        hint = f"; {_INSTEAD[name]}" if name in _INSTEAD else did_you_mean(name, known)
        return f"'Graph' object has no attribute {name!r}{hint}"

    def _publishers(self, node: Node | None) -> list[TopicPublisher[Any]]:
        """Return a node's publishers that keep nothing for late subscriptions."""
        parts = core_of(node).parts if node is not None else []
        found = [part for part in parts if isinstance(part, TopicPublisher)]
        return [publisher for publisher in found if publisher.qos.durability is Durability.VOLATILE]

    def _test_node(self) -> Node:
        if self.tester is None:
            self.tester = Node(f"_test_{next(self._names)}")
            # Starting awaits only other services, and a bare node needs none: the coroutine ends without suspending.
            _run_now(core_of(self.tester).start(self._context()))
            self.nodes.append(self.tester)
        return self.tester

    def _context(self, deadlock: DeadlockPolicy = "raise") -> Context:
        try:
            self.loop = asyncio.get_running_loop()
        except RuntimeError:
            raise RuntimeError("nodes need the event loop of a test: write async def instead of def") from None
        self._contexts.append(Context(self.network.session(self.loop), clock=self.clock, deadlock=deadlock))
        self._contexts[-1].noticed = self._noticed
        outside(self.loop).is_awaited = self.waits_outside
        outside(self.loop).ledgers.append(self._contexts[-1].ledger)
        return self._contexts[-1]


def _run_now(coroutine: Coroutine[object, object, object]) -> None:
    try:
        coroutine.send(None)
    except StopIteration:
        return
    raise AssertionError("starting a bare node waited")


_OF_PROGRAMS = (SystemExit, KeyboardInterrupt, GeneratorExit, asyncio.CancelledError)
"""BaseExceptions that do not come from a failed assertion."""
TRANSIENT_LOCAL = Qos(depth=1000, durability=Durability.TRANSIENT_LOCAL)
"""The profile for taps on latched topics."""
