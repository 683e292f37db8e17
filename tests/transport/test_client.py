"""The client session of short commands: what it is told, and that it says when there is nobody."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import zenoh

from graphflow.errors import SupervisorError, TransportError
from graphflow.transport import client as client_module
from graphflow.transport import rendezvous
from graphflow.transport.base import Answer
from graphflow.transport.client import Client
from tests.until import LIMIT, until

pytestmark = pytest.mark.real

Answering = Callable[[zenoh.Query], None]


@pytest.fixture
def client(foreign_router: zenoh.Session) -> Iterator[Client]:
    """The session of a command."""
    made = Client()
    yield made
    made.close()


def serve(session: zenoh.Session, key: str, answer: Answering) -> None:
    """Answer on a key, as a service does."""
    session.declare_queryable(key, answer, complete=True)


def test_who_is_there(foreign_router: zenoh.Session, client: Client) -> None:
    """Tokens that match, and no others; the client itself has none."""
    declare = foreign_router.liveliness().declare_token
    with declare("test/one"), declare("test/two"), declare("other/three"):
        assert sorted(client.tokens("test/*")) == ["test/one", "test/two"]
        assert not [token for token in client.tokens("**") if client.zid in token]
        assert client.tokens("nobody/*") == []


def test_everybody_reports(foreign_router: zenoh.Session, client: Client) -> None:
    """Whoever matches; errors are left out."""
    serve(foreign_router, "test/one", lambda query: query.reply("test/one", b"first"))
    serve(foreign_router, "test/two", lambda query: query.reply("test/two", b"second"))
    serve(foreign_router, "test/three", lambda query: query.reply_err(b"no"))

    assert sorted(client.reports("test/*", 5.0)) == [b"first", b"second"]
    assert client.reports("nobody/*", 5.0) == []


def test_a_call_is_answered(foreign_router: zenoh.Session, client: Client) -> None:
    """With what stands beside the answer, if anything does; an error is one; a key without servers answers None."""

    def echo(query: zenoh.Query) -> None:
        assert query.payload is not None
        assert query.attachment is not None
        query.reply("test/echo", query.payload.to_bytes()[::-1], attachment=query.attachment.to_bytes())

    serve(foreign_router, "test/echo", echo)
    serve(foreign_router, "test/bare", lambda query: query.reply("test/bare", b"bare"))
    serve(foreign_router, "test/wrong", lambda query: query.reply_err(b"wrong"))

    assert client.call("test/echo", b"abc", b"beside", 5.0) == Answer(b"cba", b"beside", False)
    assert client.call("test/bare", b"abc", b"", 5.0) == Answer(b"bare", None, False)
    assert client.call("test/wrong", b"abc", b"", 5.0) == Answer(b"wrong", None, True)
    assert client.call("test/nobody", b"abc", b"", 5.0) is None


def test_a_call_that_is_not_answered(foreign_router: zenoh.Session, client: Client) -> None:
    """It ends when its time is up."""
    kept: list[zenoh.Query] = []
    serve(foreign_router, "test/silent", kept.append)

    with pytest.raises(TimeoutError):
        client.call("test/silent", b"abc", b"", 0.05)
    kept.clear()


def test_a_command_says_when_nothing_is_running(port: int) -> None:
    """And ends with code 3."""
    with pytest.raises(SupervisorError, match="nothing is running") as caught:
        Client()
    assert caught.value.exit_code == 3


def test_a_command_that_reaches_out_says_where_it_looked(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Here and there, if it was told to look there; it ends with code 3 too."""
    monkeypatch.setenv("GRAPHFLOW_CONNECT", rendezvous.free_endpoint())
    with pytest.raises(SupervisorError, match="nor where --connect or --net points") as caught:
        Client()
    assert caught.value.exit_code == 3


def test_a_list_that_is_cut_off_is_an_error(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """It never passes for the whole."""
    monkeypatch.setattr(client_module, "TOKENS_LIMIT", 1e-9)
    with pytest.raises(TransportError, match=r"only \d+ tokens of the graph came within"):
        client.tokens("test/*")


def test_the_session_that_overloads_the_router(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is named if it announces many tokens; others and their number are not."""
    monkeypatch.setattr(client_module, "TOKENS_LIMIT", 1e-9)
    loud, quiet = "ab" * 16, "cd" * 16
    tokens = [f"@ros2_lv/0/{loud}/{i}/{i}/NN/%/%/fake{i}" for i in range(client_module.MANY_TOKENS + 1)]
    monkeypatch.setattr(client, "_known", lambda key: [*tokens, f"@ros2_lv/0/{quiet}/0/0/NN/%/%/talker"])
    with pytest.raises(TransportError, match=f"1001 of them from session {loud}, which overloads the router: end it"):
        client.tokens("@ros2_lv/*")


def test_a_list_that_still_grows(
    foreign_router: zenoh.Session, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A router that is taking in many tokens is asked until it has them all; of few it is asked once."""
    asked: list[Any] = []
    known = client._known

    def growing(key: str) -> list[str]:
        found = known(key)
        if len(asked) < 3:
            asked.append(foreign_router.liveliness().declare_token(f"test/{len(asked)}"))
        return found

    monkeypatch.setattr(client, "_known", growing)
    assert client.tokens("test/*") == []
    monkeypatch.setattr(client_module, "MANY_TOKENS", 0)
    assert sorted(client.tokens("test/*")) == ["test/0", "test/1", "test/2"]


def test_messages_from_now_on(foreign_router: zenoh.Session, client: Client) -> None:
    """Those on the key, the newest; none when the block has ended."""
    foreign_router.put("test/log", b"before")
    with client.hear("test/log", 2) as heard:
        serve(foreign_router, "test/end", lambda query: query.reply("test/end", b""))
        client.call("test/end", b"", b"", 5.0)
        for payload in (b"1", b"2", b"3"):
            foreign_router.put("test/log", payload)
        foreign_router.put("test/other", b"4")
        client.call("test/end", b"", b"", 5.0)
        assert heard.take() == [b"2", b"3"]
        assert heard.take() == []
    foreign_router.put("test/log", b"5")
    client.call("test/end", b"", b"", 5.0)
    assert heard.take() == []


def test_messages_that_arrive_while_they_are_taken(foreign_router: zenoh.Session, client: Client) -> None:
    """Each is taken once, in its order."""
    taken: list[int] = []

    def publish() -> None:
        for number in range(5000):
            foreign_router.put("test/log", str(number), congestion_control=zenoh.CongestionControl.BLOCK)

    def take() -> bool:
        taken.extend(map(int, heard.take()))
        return taken[-1:] == [4999]

    with client.hear("test/log", 10_000) as heard:
        publishing = threading.Thread(target=publish)
        publishing.start()
        until(take, "all were taken")
        publishing.join(LIMIT)
    assert taken == sorted({*taken})
