"""The link to other machines: a router session between this machine's rendezvous and routers elsewhere.

Nodes stay on loopback: what they send reaches the rendezvous, this session passes it to the routers it is connected
to, and back. It is a session of its own, next to the one that hosts the rendezvous, so that it works the same when that
is another graph's process, or rmw_zenohd, and goes when the process that asked for it goes.

A connection that is cut silently is the hard case: the other side may allow us a minute before it misses us,
and TCP retransmits ever more slowly. So a connection that goes unanswered for `PATIENCE` is dropped and dialled again.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import socket
from pathlib import Path
from typing import Any

import zenoh

from graphflow.domain import rendezvous_endpoint
from graphflow.errors import TransportError
from graphflow.graph.net import NetProfile, read_profile
from graphflow.graph.zenoh_address import endpoint
from graphflow.transport.base import Bell, Inbox
from graphflow.transport.config import (
    CONNECT_VARIABLE,
    PROFILE_VARIABLE,
    close_at_exit,
    close_session,
    config,
    open_session,
)
from graphflow.transport.event_loop.foreign_threads import at_once
from graphflow.wire import net

logger = logging.getLogger("graphflow.link")

PATIENCE = 2.0
"""Seconds that sent data may go without an acknowledgement."""
DIAL_LIMIT = 2.0
"""Seconds until the other side must have answered a dial: time for five exchanges, and a retry comes soon."""
LEASE = 4.0
"""Seconds without a sign of life after which the other side may take this one for dead; 10 is Zenoh's default."""

_MESSAGES = (
    *("put", "delete", "declare_subscriber", "query", "reply", "declare_queryable"),
    *("liveliness_token", "liveliness_query", "declare_liveliness_subscriber"),
)


class Link:
    """A link, until closed.

    Args:
        bell: Wakes the loop on which the link hears that a connection came or went.
        domain: What passes, if a profile says what may.

    Raises:
        TransportError: An endpoint is misspelt, or the port is taken.
        GraphFileError: The profile is wrong.
    """

    def __init__(self, bell: Bell, domain: int) -> None:
        profile = _profile()
        self._wanted = _endpoints(profile)
        self._linked: dict[str, int] = {}
        """Connections by endpoint."""
        self.ready = asyncio.Event()
        """Set when there has been a connection to every endpoint that must be reached."""
        self._session = open_session(self._config(profile, domain))
        close_at_exit(self._session)
        if profile is not None:
            zid, file = str(self._session.zid()), os.path.abspath(os.environ[PROFILE_VARIABLE])
            self._told = self._session.liveliness().declare_token(net.token(domain, zid, file, profile.allow))
        self._inbox = Inbox(bell, None, self._deliver)
        self._listener = self._session.info.declare_link_events_listener(at_once(self._inbox.put), history=True)
        if not self._wanted:
            self.ready.set()

    def _config(self, profile: NetProfile | None, domain: int) -> zenoh.Config:
        listen = profile.listen if profile is not None else None
        connect = [rendezvous_endpoint(), *self._wanted]
        settings = config("router", connect=connect, listen=listen, open_limit=DIAL_LIMIT, lease=LEASE)
        # Peers on both sides must not learn each other's addresses: they would try to connect directly.
        settings.insert_json5("scouting/gossip/enabled", "false")
        if profile is not None:
            settings.insert_json5("transport/link/tls", json.dumps(_tls(profile)))
            settings.insert_json5("access_control", json.dumps(_access(profile, domain)))
        return settings

    def _deliver(self) -> None:
        while self._inbox.items:
            event = self._inbox.items.popleft()
            there = str(event.link.dst).partition("#")[0].partition("?")[0]
            if there == rendezvous_endpoint():
                continue
            count = self._linked.get(there, 0) + (1 if event.kind == zenoh.SampleKind.PUT else -1)
            self._linked[there] = count
            if event.kind == zenoh.SampleKind.PUT:
                _hang_up_early(there)
                logger.info("linked to %s", there)
            elif not count:
                logger.warning("lost the link to %s", there)
        if sum(count > 0 for count in self._linked.values()) >= len(self._wanted):
            self.ready.set()

    async def wait_ready(self, timeout: float) -> None:
        """Wait until there has been a connection to every endpoint; if there is none in time, log that and go on."""
        try:
            async with asyncio.timeout(timeout):
                await self.ready.wait()
        except TimeoutError:
            logger.warning("%s: no answer yet; still trying", ", ".join(self._wanted))

    def close(self) -> None:
        """End the link. Blocks for as long as closing takes."""
        close_session(self._session)


def _profile() -> NetProfile | None:
    file = os.environ.get(PROFILE_VARIABLE)
    return read_profile(Path(file)) if file else None


def _endpoints(profile: NetProfile | None) -> list[str]:
    try:
        found = [endpoint(text) for text in os.environ.get(CONNECT_VARIABLE, "").split()]
    except ValueError as error:
        raise TransportError(str(error)) from None
    if profile is None:
        return found
    for plain in (text for text in found if not text.startswith("tls/")):
        raise TransportError(f"{plain}: with a net profile everything is encrypted; write tls/")
    return [*found, *profile.connect]


def dial() -> zenoh.Session | None:
    """A client session directly at a router elsewhere, for commands on a machine where nothing runs; None if nothing
    answers.

    Raises:
        TransportError, GraphFileError: The environment says something invalid.
    """
    profile = _profile()
    endpoints = _endpoints(profile)
    if not endpoints:
        return None
    settings = config("client", connect=endpoints, open_limit=DIAL_LIMIT, lease=LEASE)
    if profile is not None:
        settings.insert_json5("transport/link/tls", json.dumps(_tls(profile)))
    try:
        return open_session(settings)
    except TransportError:
        return None


def _tls(profile: NetProfile) -> dict[str, Any]:
    files = profile.tls
    return {
        "root_ca_certificate": files.ca,
        "listen_certificate": files.certificate,
        "listen_private_key": files.key,
        "connect_certificate": files.certificate,
        "connect_private_key": files.key,
        "enable_mtls": True,
        "verify_name_on_connect": True,
    }


def _access(profile: NetProfile, domain: int) -> dict[str, Any]:
    """What passes over encrypted connections; this machine's own are not."""
    names = [f"{domain}{pattern}/*/*" for pattern in profile.allow]  # after a name come its type and the type's hash
    latched = [f"{name}/@adv/**" for name in names]
    there = [str(zenoh.KeyExpr.autocanonize(key)) for key in (f"@ros2_lv/{domain}/**", *names, *latched)]
    allowed = {"permission": "allow", "messages": _MESSAGES, "flows": ["ingress", "egress"]}
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [
            {"id": "here", **allowed, "key_exprs": ["**", "@ros2_lv/**", "@graphflow/**", "**/@adv/**"]},
            {"id": "there", **allowed, "key_exprs": there},
        ],
        "subjects": [{"id": "here", "link_protocols": ["tcp"]}, {"id": "there", "link_protocols": ["tls"]}],
        "policies": [{"rules": [who], "subjects": [who]} for who in ("here", "there")],
    }


def _hang_up_early(there: str) -> None:
    """Make the system end connections that go unanswered for `PATIENCE`, where it supports that."""
    if not hasattr(socket, "TCP_USER_TIMEOUT"):
        return
    import psutil

    for connection in psutil.Process().net_connections("tcp"):
        far = connection.raddr
        if far and there.endswith((f"/{far.ip}:{far.port}", f"/[{far.ip}]:{far.port}")) and connection.fd >= 0:
            with socket.socket(fileno=os.dup(connection.fd)) as same:
                same.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, int(PATIENCE * 1000))
