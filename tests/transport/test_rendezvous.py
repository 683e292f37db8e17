"""What answers at the rendezvous's port is joined, or refused by name."""

from __future__ import annotations

import os
import socket
import threading
from collections.abc import Iterator
from contextlib import nullcontext
from pathlib import Path

import pytest
import zenoh

from graphflow.errors import TransportError
from graphflow.transport import rendezvous
from graphflow.transport.client import Client
from graphflow.transport.config import close_session
from tests.cases import slow

pytestmark = pytest.mark.real


def test_a_free_port_is_vacant_and_can_be_hosted(port: int) -> None:
    """Nobody is there; then this process is, and others join it."""
    assert rendezvous.join() is None
    router = rendezvous.establish()
    assert router is not None
    try:
        assert rendezvous.host() is None
        assert rendezvous.establish() is None
        session = rendezvous.join()
        assert session is not None
        (reply,) = session.liveliness().get(f"{rendezvous.TOKENS}/**", timeout=5.0)
        assert reply.ok is not None
        assert str(reply.ok.key_expr).split("/")[3:] == [str(os.getuid()), str(os.getpid())]
        close_session(session)
    finally:
        router.close()


def test_a_zenoh_router_that_is_there_is_joined(foreign_router: zenoh.Session) -> None:
    """rmw_zenohd serves as rendezvous."""
    assert rendezvous.establish() is None


@pytest.mark.parametrize("known", [True, False], ids=["known to the system", "by its token alone"])
def test_another_users_rendezvous_is_refused_by_name(
    foreign_router: zenoh.Session, known: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two users of one machine would otherwise drive each other's robots."""
    zid = foreign_router.info.zid()
    stranger = os.getuid() + 1
    monkeypatch.setattr(rendezvous, "_listener_uid", lambda port: stranger if known else None)
    with foreign_router.liveliness().declare_token(f"{rendezvous.TOKENS}/{zid}/{stranger}/4242"):
        with pytest.raises(TransportError, match=rf"belongs to user .*{stranger}.*process 4242.*--private"):
            rendezvous.establish()
        with pytest.raises(TransportError, match="belongs to user"):
            Client()


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="the system does not tell who listens")
def test_a_forged_token_locks_nobody_out(foreign_router: zenoh.Session) -> None:
    """The system knows whose rendezvous it is, whatever anybody announces."""
    zid = foreign_router.info.zid()
    with foreign_router.liveliness().declare_token(f"{rendezvous.TOKENS}/{zid}/{os.getuid() + 1}/4242"):
        assert rendezvous.establish() is None
        Client().close()


def test_only_as_much_is_read_as_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The system makes its table as it is read: of a machine with many connections all of it takes long."""

    def table() -> Iterator[str]:
        yield "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid\n"
        yield "   0: 0100007F:1D16 00000000:0000 0A 00000000:00000000 00:00000000 00000000     7        0 1\n"
        yield "   1: 0100007F:1D17 00000000:0000 0A 00000000:00000000 00:00000000 00000000  1000        0 1\n"
        raise AssertionError("more was read")

    monkeypatch.setattr(rendezvous, "open", lambda *_, **__: nullcontext(table()), raising=False)
    assert rendezvous._listener_uid(0x1D17) == 1000


def test_who_listens(port: int) -> None:
    """This user, or nobody."""
    assert rendezvous._listener_uid(port) is None
    with socket.create_server(("127.0.0.1", port)):
        assert rendezvous._listener_uid(port) in (os.getuid(), None)
    assert rendezvous.address("tcp/[::1]:7447") == ("::1", 7447)


@slow
@pytest.mark.parametrize("greeting", [b"", b"SSH-2.0-OpenSSH_9.2\r\n"])
def test_a_listener_that_is_no_zenoh_is_named(port: int, greeting: bytes) -> None:
    """Whether it says nothing or something else, its process is named, and what to do."""
    with socket.create_server(("127.0.0.1", port)) as server:
        connections = []

        def serve() -> None:
            while True:
                try:
                    connection, _ = server.accept()
                except OSError:
                    return
                connection.sendall(greeting)
                connections.append(connection)

        threading.Thread(target=serve, daemon=True).start()
        with pytest.raises(TransportError, match=rf"process {os.getpid()} .*did not answer as Zenoh.*OTHER_PORT"):
            rendezvous.establish()
        server.shutdown(socket.SHUT_RDWR)
        for connection in connections:
            connection.close()


@pytest.mark.parametrize("text", ["udp/127.0.0.1:7447", "tcp/127.0.0.1", "7447", "tcp/127.0.0.1:many"])
def test_an_endpoint_that_is_none_is_refused(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The text names the variable and shows the form."""
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", text)
    with pytest.raises(TransportError, match=r"GRAPHFLOW_RENDEZVOUS=.*tcp/127\.0\.0\.1:7447"):
        rendezvous.join()


@pytest.mark.parametrize("host", ["0.0.0.0", "192.0.2.7", "example.org"])
def test_the_rendezvous_stays_on_this_machine(host: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing listens for others by a slip of a variable."""
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", f"tcp/{host}:7447")
    with pytest.raises(TransportError, match="on this machine only"):
        rendezvous.establish()
