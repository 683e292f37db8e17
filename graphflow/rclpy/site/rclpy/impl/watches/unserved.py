"""Waits for servers that no node offers, and calls that no server answers.

In ROS 2 they last for ever, silently. Each is reported once, with the nearest name on offer.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from graphflow.rclpy.messages import classes
from graphflow.rclpy.wake import Wake
from graphflow.runtime.endpoints.service_client import nobody_serves
from graphflow.runtime.mistakes.network.unserved import GAP, WARN_AFTER, nobody_acts
from rclpy.action.client import ActionClient
from rclpy.client import Client
from rclpy.impl.deadlock.later_servers import comes_after
from rclpy.impl.deadlock.stacks import Level, stacks
from rclpy.impl.entities import action_of, clients_of, full_name, role_of, wakes_of
from rclpy.impl.nodes import internals_of, nodes_of
from rclpy.impl.watches.starvation import label_of, place_of

if TYPE_CHECKING:
    from graphflow.machines.cache import GraphCache
    from graphflow.rclpy.context_state import ContextState
    from graphflow.runtime.context import Context
    from rclpy.node import Node

_WAIT = Wake.wait.__code__
logger = logging.getLogger("graphflow")


class Unserved:
    """The clients of one context that wait for a server, or have called without one.

    Args:
        is_reported: Whether a deadlock report covers a run, `"r"`, or a thread, `"t"`, by identity or by title.
    """

    def __init__(self, life: ContextState, context: Context, is_reported: Callable[..., bool]) -> None:
        self._life, self._context, self._is_reported = life, context, is_reported
        self._since: dict[Client | ActionClient, float] = {}
        """The monotonic time at which each client was first seen to wait; a loop may wait repeatedly."""
        self._last: dict[Client | ActionClient, float] = {}
        """The time at which each of them was last seen to wait."""
        self._served: set[Client | ActionClient] = set()
        """The clients that have had a server: their names are right."""
        self._known: set[tuple[object, bool]] = set()
        """The clients that have been reported, here or elsewhere, each with whether it ever had a server."""

    def check(self) -> None:
        """Report waits that have lasted for long, and calls that were lost."""
        now = time.monotonic()
        clients = {client: node for node in nodes_of(self._life) for client in _clients(node)}
        self._served = {client for client in clients if client in self._served or _is_served(client)}
        self._known = {known for known in self._known if known[0] in clients}
        self._last = {c: last for c, last in self._last.items() if c in clients and now - last <= GAP}
        self._since = {c: since for c, since in self._since.items() if c in self._last and not _is_served(c)}
        due: dict[Any, Any] = {}
        for client, node in clients.items():
            wakes = wakes_of(client)
            if wakes and not _is_served(client):
                self._last[client] = now
                if now - self._since.setdefault(client, now) >= WARN_AFTER:
                    due.setdefault(wakes[0], client)  # one thread may wait for several
            if any(endpoint.lost for endpoint in clients_of(client)):
                self._report_lost(client, node)
        for wake, client in due.items():
            if (client, client in self._served) not in self._known:
                self._report_waiting(client, clients[client], wake, now - self._since[client])

    def _report_lost(self, client: Client | ActionClient, node: Node) -> None:
        for endpoint in clients_of(client):
            endpoint.lost = 0
        known = (client, client in self._served)
        if known in self._known:
            return
        self._known.add(known)
        wait = "wait_for_service()" if isinstance(client, Client) else "wait_for_server()"
        if client in self._served or any(endpoint.was_served for endpoint in clients_of(client)):
            text = (
                "a call of %s will never be answered: the server of %s went away before it answered, or came after it"
            )
            logger.warning(f"{text}; its terminal may say why", full_name(node), role_of(client).handler)
            return
        why = nobody(client, self._context.cache)
        text = "a call of %s will never be answered, since it has no server (%s waits for one): %s"
        logger.warning(text, full_name(node), wait, why)

    def _report_waiting(self, client: Client | ActionClient, node: Node, wake: Wake, seconds: float) -> None:
        found = next(((s, s.levels[-1]) for s in stacks() if _is_in(s.levels[-1], wake)), None)
        if found is None:
            return
        stack, level = found
        self._known.add((client, client in self._served))
        if level.run is None:
            is_reported = self._is_reported(stack.thread, "t", f"thread {stack.thread.name}")
        else:
            is_reported = self._is_reported(level.run, "r", f"{label_of(level.run)} of {full_name(node)}")
        if not is_reported:
            text = "%s has waited for %.1f s in %s: %s"
            why = nobody(client, self._context.cache) + comes_after(level.frames)
            logger.warning(text, full_name(node), seconds, place_of(level, node), why)


def nobody(client: Client | ActionClient, cache: GraphCache) -> str:
    """Describe the lack of a server for a client, and the alternatives."""
    if isinstance(client, Client):
        return nobody_serves(cache, client.endpoint.name, client.endpoint.type_name)
    return nobody_acts(cache, action_of(client), classes.type_name(internals_of(client).action_type))


def _clients(node: Node) -> Iterator[Client | ActionClient]:
    yield from list(node.clients)
    yield from [waitable for waitable in list(node.waitables) if isinstance(waitable, ActionClient)]


def _is_served(client: Client | ActionClient) -> bool:
    return clients_of(client)[0].has_server


def _is_in(level: Level, wake: Wake) -> bool:
    """Whether the code of a thread waits on this wake."""
    return any(frame.f_code is _WAIT and frame.f_locals["self"] is wake for frame in level.frames)
