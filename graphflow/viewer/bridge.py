"""A running graph for viewers: keeps their picture of it current, and carries out their requests."""

from __future__ import annotations

import asyncio
import logging
from collections import defaultdict
from collections.abc import Callable, Iterable
from typing import TypeVar

from graphflow.errors import GraphflowError, UsageFault
from graphflow.machines.cache import GraphCache
from graphflow.msgs.rosgraph_msgs.msg import Clock
from graphflow.names import is_hidden
from graphflow.qos import CLOCK
from graphflow.runtime.node import Node
from graphflow.viewer import protocol
from graphflow.viewer.client import Client, Connections
from graphflow.viewer.parameters import ParameterFields, Parameters
from graphflow.viewer.protocol import control_message
from graphflow.viewer.publications import ENCODINGS, Publications
from graphflow.viewer.server import ViewerServer
from graphflow.viewer.services import Services
from graphflow.viewer.topics import Topics
from graphflow.wire.liveliness import Kind

T = TypeVar("T")

logger = logging.getLogger("graphflow")

UPDATE_INTERVAL = 0.2
"""Seconds between two updates while the graph changes."""


class Bridge:
    """Serves the graph of a node from `open` to `close`.

    Args:
        name: The name of the server in viewers.
        is_read_only: Whether viewers may neither publish, nor call, nor set parameters.
        pages: Origins of further web pages that may connect: `https://viewer.example`.
    """

    def __init__(
        self, node: Node, name: str, *, is_read_only: bool = False, pages: frozenset[str] = frozenset()
    ) -> None:
        self._node, self._name = node, name
        self._is_read_only = is_read_only
        self._viewers = ViewerServer(self, pages)
        self._topics = Topics(node, self._viewers.broadcast)
        self._services = Services(node, self._viewers.broadcast)
        self._publications = Publications(node)
        self._parameters = Parameters(node, self._changed)
        self._is_clocked = False
        """Whether /clock is subscribed to."""
        self._watching: asyncio.Task[None] | None = None

    async def open(self, host: str, port: int) -> int:
        """Start the server; return its port.

        Args:
            port: 0 for any free one.

        Raises:
            TransportError: The server cannot listen there.
        """
        found = await self._viewers.open(host, port)
        self._follow_clock()
        self._watching = asyncio.ensure_future(self._watch_graph())
        return found

    async def close(self) -> None:
        """Stop the server and disconnect the viewers."""
        if self._watching is not None:
            self._watching.cancel()
        await self._viewers.close()
        self._topics.close()
        self._services.close()

    # clients

    def greet(self, client: Client) -> None:
        """Tell a new client what there is."""
        capabilities = ["parameters", "parametersSubscribe", "connectionGraph", "assets"]
        capabilities += [] if self._is_read_only else ["clientPublish", "services"]
        capabilities += ["time"] if self._is_clocked else []
        client.send_control(
            control_message(
                "serverInfo", name=self._name, capabilities=capabilities, supported_encodings=ENCODINGS, metadata={}
            )
        )
        self._topics.greet(client)
        if not self._is_read_only:
            self._services.greet(client)

    def leave(self, client: Client) -> None:
        """End all subscriptions of a client, and withdraw its channels."""
        self._topics.leave(client)
        self._publications.leave(client)

    def handle(self, client: Client, request: protocol.ClientMessage) -> None:
        """Carry out a client's request.

        Raises:
            GraphflowError: The request cannot be carried out; the text is for the client.
        """
        if self._handle_query(client, request):
            return
        if self._is_read_only:
            raise UsageFault("this server is read-only; see --allow-commands of graphflow view")
        self._handle_command(client, request)

    def _handle_query(self, client: Client, request: protocol.ClientMessage) -> bool:
        """Carry out a request that only reads; return whether it is one."""
        match request:
            case protocol.Subscribe():
                _each(client, request.subscriptions, self._topics.subscribe)
            case protocol.Unsubscribe():
                for number in request.subscription_ids:
                    self._topics.unsubscribe(client, number)
            case protocol.GetParameters():
                client.spawn(lambda: self._send_parameters(client, request.parameter_names, request.id))
            case protocol.FollowParameters():
                is_start = request.op == "subscribeParameterUpdates"
                self._follow_parameters(client, {*request.parameter_names}, wanted=is_start)
            case protocol.FollowGraph():
                client.graph = {} if request.op == "subscribeConnectionGraph" else None
                self._send_graph(client, connections(self._node.context.cache))
            case _:
                return False
        return True

    def _handle_command(self, client: Client, request: protocol.ClientMessage) -> None:
        """Carry out a request that publishes, calls or sets."""
        match request:
            case protocol.SetParameters():
                client.spawn(lambda: self._set_parameters(client, request))
            case protocol.Advertise():
                _each(client, request.channels, self._publications.announce)
            case protocol.Unadvertise():
                for number in request.channel_ids:
                    self._publications.withdraw(client, number)
            case protocol.Message():
                self._publications.publish(client, request)
            case protocol.Call():
                client.spawn(lambda: self._services.call(client, request))

    # parameters, time and graph

    async def _send_parameters(self, client: Client, names: list[str], about: str | None) -> None:
        client.send_control(control_message("parameterValues", parameters=await self._parameters.get(names), id=about))

    async def _set_parameters(self, client: Client, request: protocol.SetParameters) -> None:
        try:
            await self._parameters.set(request.parameters)
        finally:
            if request.parameters:
                await self._send_parameters(client, [value.name for value in request.parameters], request.id)

    def _follow_parameters(self, client: Client, names: set[str], *, wanted: bool) -> None:
        """Start or stop reporting changes of parameters to a client: of those named, or of all if none is.

        Raises:
            UsageFault: The client follows too many.
        """
        if not names:
            client.follows_all = wanted
        if not names and not wanted:
            client.followed.clear()
        if wanted and len(client.followed | names) > protocol.ENTRIES_BOUND:
            raise UsageFault(
                f"a viewer cannot follow more than {protocol.ENTRIES_BOUND} parameters; name none to follow all"
            )
        client.followed = client.followed | names if wanted else client.followed - names

    def _changed(self, parameters: list[ParameterFields]) -> None:
        for client in self._viewers.clients:
            wanted = [p for p in parameters if client.follows_all or p["name"] in client.followed]
            if wanted:
                client.send_control(control_message("parameterValues", parameters=wanted))

    def _clock_received(self, message: Clock) -> None:
        if message.clock.sec >= 0:
            self._viewers.broadcast(protocol.time_frame(message.clock.sec * 10**9 + message.clock.nanosec))

    def _follow_clock(self) -> None:
        """Follow /clock once it has a publisher. Viewers that connect later use simulated time."""
        if not self._is_clocked and self._node.context.cache.endpoints(Kind.PUBLISHER, "/clock"):
            self._is_clocked = True
            self._node.create_subscription(Clock, "/clock", self._clock_received, CLOCK)

    async def _watch_graph(self) -> None:
        is_new = asyncio.Event()
        stop = self._node.context.on_change(lambda _: is_new.set())
        try:
            while True:
                is_new.clear()
                self._follow_clock()
                self._topics.update()
                if not self._is_read_only:
                    self._services.update()
                graph = connections(self._node.context.cache)
                for client in self._viewers.clients:
                    self._send_graph(client, graph)
                await is_new.wait()
                await asyncio.sleep(UPDATE_INTERVAL)  # nodes announce their endpoints in bursts
        finally:
            stop()

    def _send_graph(self, client: Client, graph: Connections) -> None:
        """Send a client the changes of the connection graph since its last update."""
        if client.graph is None or client.graph == graph:
            return
        known, update = client.graph, {}
        for part, (key, members) in PARTS.items():
            now, then = graph[part], known.get(part, {})
            update[part] = [{key: name, members: users} for name, users in now.items() if then.get(name) != users]
        topics = {*known.get("publishedTopics", ()), *known.get("subscribedTopics", ())}
        removed = {
            "removedTopics": sorted(topics - {*graph["publishedTopics"], *graph["subscribedTopics"]}),
            "removedServices": sorted({*known.get("advertisedServices", ())} - {*graph["advertisedServices"]}),
        }
        client.graph = graph
        client.send_control(control_message("connectionGraphUpdate", **update, **removed))


def _each(client: Client, wanted: Iterable[T], work: Callable[[Client, T], None]) -> None:
    """Process the entries of a request one by one; a failed one is reported to the client, and the others go on."""
    for entry in wanted:
        try:
            work(client, entry)
        except GraphflowError as error:
            client.warn(str(error))


PARTS = {
    "publishedTopics": ("name", "publisherIds"),
    "subscribedTopics": ("name", "subscriberIds"),
    "advertisedServices": ("name", "providerIds"),
}
"""The parts of the connection graph, with the keys of their entries."""


def connections(cache: GraphCache) -> Connections:
    """Return the publishers, subscribers and servers in the graph, without hidden ones."""
    found: Connections = {}
    for part, kind in zip(PARTS, (Kind.PUBLISHER, Kind.SUBSCRIPTION, Kind.SERVICE), strict=True):
        nodes: dict[str, set[str]] = defaultdict(set)
        for entity in cache.endpoints(kind):
            if not (is_hidden(entity.name) or is_hidden(entity.node_name)):
                nodes[entity.name].add(entity.node_name)
        found[part] = {name: sorted(users) for name, users in sorted(nodes.items())}
    return found
