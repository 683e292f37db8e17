"""The link to other machines: a router session between this machine's rendezvous and routers elsewhere.

Nodes stay on loopback: their messages reach the rendezvous, and this session passes them to the routers it is
connected to, and back. It is separate from the session that hosts the rendezvous, so that it works the same if that is
another graph's process or rmw_zenohd, and ends with the process that opened it.

A silently cut connection is the hard case: the other side may take a minute to notice, and TCP retransmits ever more
slowly. So a connection without an acknowledgement for `PATIENCE` is dropped and dialled again.
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
from graphflow.transport.config import (
    CONNECT_VARIABLE,
    PROFILE_VARIABLE,
    close_at_exit,
    close_session,
    config,
    open_session,
)
from graphflow.transport.event_loop.foreign_threads import at_once
from graphflow.transport.inbox import Bell, Inbox
from graphflow.wire import net

logger = logging.getLogger("graphflow.link")

PATIENCE = 2.0
"""Seconds for sent data to be acknowledged."""
DIAL_LIMIT = 2.0
"""Seconds for the other side to answer a dial: time for five round trips, and a retry follows soon."""
LEASE = 4.0
"""Seconds of silence after which the other side considers this one dead; Zenoh's default is 10."""

_MESSAGES = (
    *("put", "delete", "declare_subscriber", "query", "reply", "declare_queryable"),
    *("liveliness_token", "liveliness_query", "declare_liveliness_subscriber"),
)


class Link:
    """A link, until closed.

    Args:
        bell: Wakes the loop for changes of connections.
        domain: The domain to which a net profile's rules apply.

    Raises:
        TransportError: An endpoint is malformed, or the port is taken.
        GraphFileError: The net profile is invalid.
    """

    def __init__(self, bell: Bell, domain: int) -> None:
        profile = _profile()
        self._wanted = _endpoints(profile)
        self._linked: dict[str, int] = {}
        """Number of connections, by endpoint."""
        self.ready = asyncio.Event()
        """Set once every required endpoint has been connected."""
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
            # An endpoint may have metadata after `?` and settings after `#`, which an address in `_wanted` lacks.
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
        """Wait until every endpoint has been connected; on a timeout, log it and continue."""
        try:
            async with asyncio.timeout(timeout):
                await self.ready.wait()
        except TimeoutError:
            logger.warning("%s: no answer yet; still trying", ", ".join(self._wanted))

    def close(self) -> None:
        """Close the link. Blocks until it is closed."""
        close_session(self._session)


def _profile() -> NetProfile | None:
    file = os.environ.get(PROFILE_VARIABLE)
    return read_profile(Path(file)) if file else None


def _endpoints(profile: NetProfile | None) -> list[str]:
    try:
        found = [endpoint(text) for text in os.environ.get(CONNECT_VARIABLE, "").split()]
    except ValueError as error:
        raise TransportError(f"{CONNECT_VARIABLE}: {error}") from None
    if profile is None:
        return found
    for plain in (text for text in found if not text.startswith("tls/")):
        raise TransportError(f"{plain}: with a net profile everything is encrypted; write tls/")
    return [*found, *profile.connect]


def dial() -> zenoh.Session | None:
    """Open a client session at a router elsewhere, for commands on a machine where nothing runs.

    Returns:
        The session; None if no router answers.

    Raises:
        TransportError, GraphFileError: The environment's link settings are invalid.
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
    """Return the access rules of encrypted connections; this machine's own are unencrypted."""
    # In a key, a name is followed by its type and the type's hash.
    names = [f"{domain}{pattern}/*/*" for pattern in profile.allow]
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
    """Make the system end connections without an acknowledgement for `PATIENCE`, where supported."""
    if not hasattr(socket, "TCP_USER_TIMEOUT"):
        return
    import psutil

    # Zenoh does not reveal its sockets: they are found among all of this process by their peer's address.
    for connection in psutil.Process().net_connections("tcp"):
        far = connection.raddr
        if far and there.endswith((f"/{far.ip}:{far.port}", f"/[{far.ip}]:{far.port}")) and connection.fd >= 0:
            # A duplicate shares the connection's options, and closing it leaves Zenoh's descriptor open.
            with socket.socket(fileno=os.dup(connection.fd)) as same:
                same.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, int(PATIENCE * 1000))
