"""The graph as seen from outside it, for short commands: without asyncio and without taking part."""

from __future__ import annotations

import logging
import time
from collections.abc import Iterable
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from graphflow.errors import (
    CallError,
    CallTimeout,
    RemoteError,
    ServerLost,
    ServiceUnavailable,
    SupervisorError,
)
from graphflow.machines.cache import GraphCache
from graphflow.machines.domains import COMMANDS, elsewhere
from graphflow.machines.near_topics import by_type, did_you_mean_topic
from graphflow.names import did_you_mean
from graphflow.transport.base import Answer
from graphflow.transport.client import Client, Hearing
from graphflow.transport.config import reaches_out
from graphflow.wire import attachment, net, process
from graphflow.wire.keyexpr import DataKey
from graphflow.wire.liveliness import NODES, Kind, watch_key
from graphflow.wire.net import NetToken
from graphflow.wire.process import ProcessToken

if TYPE_CHECKING:
    from graphflow.msgs.base import Message

logger = logging.getLogger("graphflow")

TAKEN_SHOWN = 5
"""Most taken names that an error lists."""
STOPPED_SHOWN = 3
"""Most stopped processes that an error lists."""
PATIENCE = 0.5
"""Seconds that a node has to answer a call that checks its existence."""
NODE_SERVICES = {
    "get_parameters": "rcl_interfaces/srv/GetParameters",
    "get_type_description": "type_description_interfaces/srv/GetTypeDescription",
}
"""Services of every node, with their types."""
GID = bytes(16)
"""The GID of commands, which are not entities of the graph and so have none of their own."""


class View:
    """The graph of a domain at one moment, and calls into it. A context manager.

    Raises:
        SupervisorError: Nothing is running (exit 3).
        TransportError: The rendezvous is not usable.
    """

    def __init__(self, domain: int) -> None:
        self.domain = domain
        self._client = Client()
        self._calls = 0
        self.refresh()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._client.close()

    def refresh(self) -> None:
        """Read the graph again."""
        # Query both together: the router forgets a process that does not answer within a few seconds.
        self._processes = self._client.tokens(process.watch_key(self.domain))
        self.cache = GraphCache(self._client.tokens(watch_key(self.domain)))

    def node(self, name: str) -> str:
        """Return the full name of the node `name`, whose leading slash may be missing.

        Raises:
            CallError: There is no such node; the text suggests the nearest.
        """
        wanted = name if name.startswith("/") else f"/{name}"
        nodes = self.cache.nodes()
        if wanted in nodes:
            return wanted
        visible = self.cache.nodes(hidden=False)
        why = self.cache.instead(wanted, visible) or self._empty(visible)
        raise CallError(f"there is no node {wanted}{why}{self._stopped()}")

    def _empty(self, names: Iterable[str]) -> str:
        return "" if names else self.nobody_here() or f"; domain {self.domain} has no nodes"

    def nobody_here(self) -> str:
        """Return `; this domain, 5, has no other nodes; domain 0 has 3: ...` to end an error with; or an empty text."""
        text = elsewhere(self.domain, self._client.tokens(NODES), COMMANDS)
        return text and f"; {text}"

    def subscribed_only(self, topic: str) -> str:
        """Return who subscribes to a topic that no node publishes, as `; /plot subscribes to it`; "" if one does."""
        nodes = sorted({entity.node_name for entity in self.cache.endpoints(Kind.SUBSCRIPTION, topic)})
        if not nodes or self.cache.endpoints(Kind.PUBLISHER, topic):
            return ""
        verb = "subscribes" if len(nodes) == 1 else "subscribe"
        own = self.cache.endpoints(Kind.SUBSCRIPTION, topic)[0]
        meant = did_you_mean_topic(own, by_type(self.cache, {own.type})).partition("; did you mean ")[2]
        why = self.cache.absolute(topic) or (f"; did you mean {meant}" if meant else self._stopped())
        return f"; {' and '.join(nodes[:TAKEN_SHOWN])} {verb} to it, and nothing publishes it{why}"

    def service_types(self, name: str, wanted: str = "") -> list[str]:
        """Return the types of an offered service: several, if nodes announce different ones.

        Args:
            wanted: The type that the caller expects, for the suggestion.

        Raises:
            ServiceUnavailable: No node offers it; the text suggests the nearest.
        """
        types = sorted({server.type for server in self.cache.endpoints(Kind.SERVICE, name)})
        if types:
            return types
        named, offered = self.cache.named(name), self.cache.offered()
        if wanted and not named:
            near = self.cache.service_of_type(name, wanted)
        elif any(e.kind is Kind.CLIENT for e in named):
            near = did_you_mean(name, *offered)
        else:
            near = self.cache.instead(name, *offered)
        raise ServiceUnavailable(f"no node offers the service {name}{near or self.nobody_here()}{self._stopped()}")

    def wait_for_service(self, name: str, timeout: float, wanted: str = "") -> None:
        """Wait until a node offers the service.

        Args:
            wanted: The type that the caller expects, for the suggestion.

        Raises:
            ServiceUnavailable: No node did within `timeout` seconds.
        """
        deadline = time.monotonic() + timeout
        while not self.cache.endpoints(Kind.SERVICE, name):
            if time.monotonic() > deadline:
                # It raises, with the nearest name.
                self.service_types(name, wanted)
            time.sleep(0.05)
            self.refresh()

    def call(self, name: str, type_name: str, request: Message, timeout: float = 10.0, *, plain: bool = False) -> Any:
        """Call a service and return the response message.

        Args:
            name: Full name of the service.
            type_name: `package/srv/Name`, as the server announces it.
            request: A message of its request type.
            timeout: Seconds.
            plain: Whether numeric arrays of the response are lists.

        Raises:
            CallError: As for `ServiceClient.call`.
        """
        from graphflow.msgs import registry

        service = registry.service_schema(type_name)
        key = str(DataKey(self.domain, name, type_name, registry.hash_of(type_name)))
        self._calls += 1
        beside = attachment.pack(self._calls, time.time_ns(), GID)
        try:
            reply = self._client.call(key, request.to_bytes(), beside, timeout)
        except TimeoutError:
            raise CallTimeout(f"{name} did not answer within {timeout:g} s{self._stopped()}") from None
        if reply is None:
            raise ServerLost(self._no_answer(name, type_name, registry.hash_of(type_name)))
        if reply.is_error:
            raise RemoteError.from_payload(reply.payload, name)
        codec = registry.plain_codec if plain else registry.codec
        return codec(service.response.name).decode(reply.payload)

    def hear(self, name: str, type_name: str, bound: int) -> Hearing:
        """Receive what is published on a topic from now on, serialized; the newest `bound` messages are kept."""
        from graphflow.msgs import registry

        return self._client.hear(str(DataKey(self.domain, name, type_name, registry.hash_of(type_name))), bound)

    def reports(self, key: str, timeout: float) -> list[bytes]:
        """Query all graphflow processes on one of graphflow's keys; return their answers."""
        return self._client.reports(key, timeout)

    def ask(self, key: str, request: bytes, timeout: float) -> Answer:
        """Query one graphflow process on one of graphflow's keys.

        Raises:
            TimeoutError: The process did not answer in time.
            ServerLost: The process has ended.
        """
        answer = self._client.call(key, request, attachment.pack(1, 0, GID), timeout)
        if answer is None:
            raise ServerLost("the process has ended")
        return answer

    def owner(self, name: str) -> str:
        """Describe the process or session in which a node runs, from its tokens."""
        token = self.process_of(name)
        if token is not None:
            return f"{token}: {token.command}" if token.command else str(token)
        zids = {e.zid for e in self.cache.owners(name)}
        profiles = self.profiles()
        beyond = f"beyond {profiles[0]}" if profiles else "on another machine" if reaches_out() else ""
        return f"session {', '.join(sorted(zids))}, no graphflow process{f', or {beyond}' if beyond else ''}"

    def process_of(self, name: str) -> ProcessToken | None:
        """Return the process in which a node runs; None if it is not graphflow's."""
        processes = self.processes()
        return next((processes[e.zid] for e in self.cache.owners(name) if e.zid in processes), None)

    def profiles(self) -> list[NetToken]:
        """Return the net profiles in force on this machine."""
        return [found for text in self._client.tokens(net.watch_key(self.domain)) if (found := net.parse(text))]

    def kept_back(self, name: str, kind: Kind) -> str:
        """Describe the net profile that does not pass a topic or service to this machine; empty if there is none.

        Sessions of graphflow that can be seen are on this machine, within which everything passes.
        """
        offering = {e.zid for e in self.cache.endpoints(kind, name)}
        if not offering or not offering.isdisjoint(self.processes()):
            return ""
        return net.refusal(name, self.profiles())

    def why_silent(self, topic: str) -> str:
        """Describe what may keep the messages of a topic from this machine; empty if nothing is known to."""
        publishers = {e.zid for e in self.cache.endpoints(Kind.PUBLISHER, topic)}
        if not publishers or not publishers.isdisjoint(self.processes()) or not self._is_linked():
            return ""
        beyond = f"{topic} is published on another machine, whose net profile may not pass it: add it to `allow` there"
        return self.kept_back(topic, Kind.PUBLISHER) or beyond

    def _is_linked(self) -> bool:
        return bool(self.profiles()) or reaches_out()

    def is_there(self, name: str) -> bool:
        """Whether a node exists, rather than only its liveliness token, which anybody can announce.

        It does if one of the services of every node answers, or leaves the query open, as a stopped process does.
        Without a server, Zenoh ends the query at once.
        """
        from graphflow.msgs import registry

        if not all(profile.passes(f"{name}/{service}") for profile in self.profiles() for service in NODE_SERVICES):
            return True  # the query may not reach it
        for service, type_name in NODE_SERVICES.items():
            request = registry.example(f"{type_name}_Request").to_bytes()
            for server in self.cache.endpoints(Kind.SERVICE, f"{name}/{service}"):
                if server.type == type_name:
                    try:
                        reply = self._client.call(server.data_key, request, attachment.pack(1, 0, GID), PATIENCE)
                    except TimeoutError:
                        return True
                    if reply is not None:
                        return True
        return False

    def processes(self) -> dict[str, ProcessToken]:
        """Return the graphflow processes in the domain by session, as of the last `refresh`."""
        tokens = map(process.parse, self._processes)
        return {token.zid: token for token in tokens if token is not None}

    def _no_answer(self, name: str, type_name: str, hash_: str) -> str:
        servers = self.cache.endpoints(Kind.SERVICE, name)
        same = [server for server in servers if server.type == type_name]
        if servers and not same:
            return f"{name} is of type {' and '.join(self.service_types(name))}, not {type_name}"
        if same and all(server.hash != hash_ for server in same):
            from graphflow.msgs import registry

            why = registry.why_different(type_name)
            return f"{name}: the server's definition of {type_name} differs from the one here{why}"
        if kept_back := self.kept_back(name, Kind.SERVICE):
            return kept_back
        self.refresh()
        here = self.processes()
        still = [e for e in self.cache.endpoints(Kind.SERVICE, name) if e.type == type_name and e.zid not in here]
        if still and self._is_linked():
            why = "the net profile of its machine does not pass the call: add it to `allow` on both"
            return f"{name} is announced, and does not answer: {why}"
        return f"{name}: the server went away before it answered{self._stopped() or '; its terminal may say why'}"

    def _stopped(self) -> str:
        """Describe stopped processes (SIGSTOP), which the router has forgotten by now, to append to an error."""
        return "".join(f"; {text}" for text in list(process.stopped(self.domain).values())[:STOPPED_SHOWN])


def refuse_taken_names(names: Iterable[str], domain: int, hint: str = "rename the node in the graph file") -> None:
    """Check that no node of the domain has one of `names`.

    Args:
        hint: How to give a node another name.

    A node that is announced but does not exist takes no name; it is logged.

    Raises:
        SupervisorError: Some names are taken; the text lists the processes.
    """
    try:
        view = View(domain)
    except SupervisorError as error:
        if error.exit_code == 3:  # nothing is running, so nothing is taken
            return
        raise
    with view:
        announced = sorted(set(names) & set(view.cache.nodes()))
        taken = [name for name in announced if view.is_there(name)]
        for name in sorted({*announced} - {*taken}):
            logger.warning(
                "%s is announced in domain %s by %s, but does not answer: starting it nevertheless",
                *(name, domain, view.owner(name)),
            )
        if taken:
            owners = "; ".join(f"{name} ({view.owner(name)})" for name in taken[:TAKEN_SHOWN])
            more = f"; and {len(taken) - TAKEN_SHOWN} more" if len(taken) > TAKEN_SHOWN else ""
            raise SupervisorError(
                f"already in domain {domain}: {owners}{more}. Stop those nodes, {hint}, or choose another domain: "
                "graphflow --domain N ..."
            )
