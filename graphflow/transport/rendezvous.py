"""The rendezvous: one router per machine, for all domains, through which sessions discover each other.

It is a second session inside a long-lived graphflow process, the first to bind the port. When that process dies, the
others, whose direct links continue, try to take over the port at once. An existing Zenoh router, such as rmw_zenohd, is
joined. Any other program on the port is an error that names it.
"""

from __future__ import annotations

import os

import zenoh

from graphflow.domain import ENDPOINT_VARIABLE, rendezvous_endpoint
from graphflow.errors import TransportError
from graphflow.graph.zenoh_address import port_fault
from graphflow.system import user_id
from graphflow.transport.config import close_session, config, open_session
from graphflow.transport.forked import leave_port

TOKENS = "@graphflow/rendezvous"
"""A rendezvous announces itself as `@graphflow/rendezvous/<zid>/<uid>/<pid>`."""
ANSWER_LIMIT = 0.5
"""Seconds for a listener to answer."""
_LISTENS = "0A"
"""The state of a listening TCP socket in Linux's tables."""
PATIENCE = 2.0
"""Seconds for a second attempt before a listener counts as mute: a busy machine may take that long."""


def address(endpoint: str) -> tuple[str, int]:
    """Return host and port of `tcp/HOST:PORT`.

    Raises:
        TransportError: `endpoint` has another form.
    """
    protocol, _, rest = endpoint.partition("/")
    host, _, port = rest.rpartition(":")
    if protocol != "tcp" or not port.isdecimal() or not 0 < int(port) < 65536:
        fault = port_fault(port) or "write it as tcp/127.0.0.1:7447"
        raise TransportError(f"{ENDPOINT_VARIABLE}={endpoint!r}: {fault}")
    if not (host in ("localhost", "[::1]") or host.startswith("127.")):
        raise TransportError(f"{ENDPOINT_VARIABLE}={endpoint!r}: the rendezvous is on this machine only, at 127.0.0.1")
    return host.strip("[]"), int(port)


def join() -> zenoh.Session | None:
    """Open a client session at the rendezvous; None if nothing listens there.

    Raises:
        TransportError: The listener is not Zenoh, does not answer, or belongs to another user.
    """
    endpoint = rendezvous_endpoint()
    address(endpoint)
    session = _open_client(endpoint, ANSWER_LIMIT)
    if session is None and _is_listening(endpoint):  # it may have bound the port between the two checks
        session = _open_client(endpoint, PATIENCE)
        if session is None:
            raise TransportError(occupied(endpoint, f"did not answer as Zenoh within {PATIENCE:g} s"))
    if session is None:
        return None
    try:
        _refuse_strangers(session, endpoint)
    except BaseException:  # interrupts included: nothing stays open
        close_session(session)
        raise
    return session


def _open_client(endpoint: str, limit: float) -> zenoh.Session | None:
    try:
        return open_session(config("client", connect=[endpoint], open_limit=limit))
    except TransportError:
        return None


def _is_listening(endpoint: str) -> bool:
    import socket  # only for an error message: importing it takes a tenth of a listing's time

    try:
        socket.create_connection(address(endpoint), ANSWER_LIMIT).close()
    except ConnectionRefusedError:
        return False
    except OSError as error:
        raise TransportError(occupied(endpoint, f"cannot be reached ({error})")) from None
    return True


def _refuse_strangers(session: zenoh.Session, endpoint: str) -> None:
    uid = _listener_uid(address(endpoint)[1])
    if uid == user_id():  # the socket's owner outweighs any announcement
        return
    here = {str(zid) for zid in session.info.routers_zid()}  # routers of other machines may be linked to it
    for reply in session.liveliness().get(f"{TOKENS}/**", timeout=ANSWER_LIMIT):
        if reply.ok is None:
            continue
        parts = str(reply.ok.key_expr).split("/")
        if len(parts) == 5 and parts[2] in here and parts[3] != str(user_id()):
            raise TransportError(
                f"the rendezvous at {endpoint} belongs to user {_user_name(parts[3])} (process {parts[4]}); "
                f"your nodes and theirs would see each other. Start with --private for a port and a domain of your "
                f"own, or set {ENDPOINT_VARIABLE}=tcp/127.0.0.1:PORT"
            )


def _listener_uid(port: int) -> int | None:
    """Return the user id of a TCP port's listener from Linux's tables; None if unknown."""
    for table in ("/proc/net/tcp", "/proc/net/tcp6"):
        try:
            with open(table, encoding="ascii") as file:
                next(file, "")  # the column headings
                # Listening sockets come first. The kernel creates the table as it is read, and for all connections of a
                # machine that takes milliseconds.
                for fields in map(str.split, file):
                    if fields[3] == _LISTENS and int(fields[1].rpartition(":")[2], 16) == port:
                        return int(fields[7])
        except OSError:
            continue
    return None


def _user_name(uid: str) -> str:
    try:
        import pwd

        return f"{pwd.getpwuid(int(uid)).pw_name} ({uid})"
    except (ImportError, KeyError, ValueError):
        return uid


def occupied(endpoint: str, what: str) -> str:
    """Return a sentence on a process that occupies an endpoint, with the next step."""
    owner = _listener(address(endpoint)[1])
    return (
        f"{endpoint}: {owner or 'the process listening there'} {what}. End it"
        f"{f' (or continue it, if it is stopped: kill -CONT {owner.split()[1]})' if owner else ''}, "
        f"or set {ENDPOINT_VARIABLE}={endpoint.rpartition(':')[0]}:OTHER_PORT"
    )


def _listener(port: int) -> str:
    """Return `process PID (name)` of a TCP port's listener, as far as this user may see it."""
    import psutil

    try:
        for connection in psutil.net_connections("tcp"):
            here = connection.laddr and connection.laddr.port == port
            if here and connection.status == psutil.CONN_LISTEN and connection.pid:
                return f"process {connection.pid} ({psutil.Process(connection.pid).name()})"
    except psutil.Error:
        return ""
    return ""


class Router:
    """The rendezvous, hosted by this process until closed."""

    def __init__(self, session: zenoh.Session) -> None:
        self._session = session
        name = f"{TOKENS}/{session.info.zid()}/{user_id()}/{os.getpid()}"
        self._token = session.liveliness().declare_token(name)

    def close(self) -> None:
        """Stop hosting the rendezvous. Blocks until it is closed."""
        close_session(self._session)


def host() -> Router | None:
    """Host the rendezvous: a router session on its port; None if the port is taken."""
    endpoint = rendezvous_endpoint()
    try:
        router = Router(open_session(config("router", listen=endpoint)))
    except TransportError:
        return None
    leave_port(address(endpoint)[1])
    return router


def free_endpoint() -> str:
    """Return an endpoint on a free loopback port.

    It is below the ephemeral ports, so that only a rendezvous's successor gets its port.
    """
    import random
    import socket

    while True:
        port = random.SystemRandom().randrange(10_000, 32_000)
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:  # the port is taken
                continue
        return f"tcp/127.0.0.1:{port}"


def establish() -> Router | None:
    """Ensure that there is a rendezvous: join an existing one, else host it. Blocks for a few milliseconds.

    Returns:
        The router if this process now hosts the rendezvous, else None.

    Raises:
        TransportError: As for `join`.
    """
    # Other processes start and end meanwhile: between the two steps the port may be bound or become free.
    for _ in range(5):
        session = join()
        if session is not None:
            close_session(session)
            return None
        router = host()
        if router is not None:
            return router
    raise TransportError(occupied(rendezvous_endpoint(), "can neither be bound nor joined"))
