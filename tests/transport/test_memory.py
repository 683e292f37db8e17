"""The network inside one process keeps the real one's promises."""

from __future__ import annotations

import asyncio
import gc

import pytest

from graphflow.qos import Durability, Qos
from graphflow.testing.clock import settle
from graphflow.transport.base import Answer
from graphflow.transport.inbox import Inbox
from graphflow.transport.memory import MemorySession, Network
from tests.cases import slow


def nothing() -> None:
    """Nobody wants to know."""


VOLATILE = Qos()
LATCHED = Qos(depth=3, durability=Durability.TRANSIENT_LOCAL)


class Talk:
    """Sessions on one network."""

    def __init__(self) -> None:
        self.network = Network()
        self.one = self.session()
        self.two = self.session()

    def session(self) -> MemorySession:
        return self.network.session(asyncio.get_running_loop())


def inbox_of(session: MemorySession, depth: int = 100) -> Inbox:
    return Inbox(session.bell, depth, lambda: None)


def heard(session: MemorySession, inbox: Inbox) -> list[tuple[bytes, bytes | None]]:
    return [session.read(item) for item in inbox.items]


async def test_a_publication_reaches_every_receiver_of_its_key(graphflow_runner: asyncio.Runner) -> None:
    """The sender's own session included; other keys hear nothing."""
    talk = Talk()
    here, there, elsewhere = inbox_of(talk.one), inbox_of(talk.two), inbox_of(talk.two)
    talk.one.open_receiver("k", VOLATILE, here)
    talk.two.open_receiver("k", VOLATILE, there)
    talk.two.open_receiver("k/more", VOLATILE, elsewhere)

    talk.one.open_sender("k", VOLATILE).put(b"data", attachment=b"beside")

    assert heard(talk.one, here) == heard(talk.two, there) == [(b"data", b"beside")]
    assert not elsewhere.items


async def test_nothing_is_delivered_inside_the_call_that_sent_it(graphflow_runner: asyncio.Runner) -> None:
    """A receiver is told by the loop, in the order of sending."""
    talk = Talk()
    seen: list[bytes] = []

    def ready() -> None:
        while inbox.items:
            seen.append(talk.two.read(inbox.items.popleft())[0])

    inbox = Inbox(talk.two.bell, 100, ready)
    talk.two.open_receiver("k", VOLATILE, inbox)
    sender = talk.one.open_sender("k", VOLATILE)
    sender.put(b"1", attachment=b"")
    sender.put(b"2", attachment=b"")
    assert seen == []
    await settle()

    assert seen == [b"1", b"2"]


async def test_a_payload_is_what_it_was_when_it_was_sent(graphflow_runner: asyncio.Runner) -> None:
    """The sender may use its buffer again at once."""
    talk = Talk()
    inbox = inbox_of(talk.two)
    talk.two.open_receiver("k", VOLATILE, inbox)
    buffer = bytearray(b"old")

    talk.one.open_sender("k", VOLATILE).put(memoryview(buffer), attachment=b"")
    buffer[:] = b"new"

    assert heard(talk.two, inbox) == [(b"old", b"")]


async def test_a_closed_receiver_hears_nothing_more(graphflow_runner: asyncio.Runner) -> None:
    """Closing twice is harmless."""
    talk = Talk()
    inbox = inbox_of(talk.two)
    receiver = talk.two.open_receiver("k", VOLATILE, inbox)
    receiver.close()
    receiver.close()

    talk.one.open_sender("k", VOLATILE).put(b"x", attachment=b"")

    assert not inbox.items


async def test_a_latecomer_gets_the_history_of_a_latched_key(graphflow_runner: asyncio.Runner) -> None:
    """The newest messages, as many as both sides keep, and only if the receiver asks for them."""
    talk = Talk()
    sender = talk.one.open_sender("k", LATCHED)
    for n in range(5):
        sender.put(b"%d" % n, attachment=b"")
    all_kept, two, none = inbox_of(talk.two), inbox_of(talk.two), inbox_of(talk.two)

    talk.two.open_receiver("k", LATCHED, all_kept)
    talk.two.open_receiver("k", Qos(depth=2, durability=Durability.TRANSIENT_LOCAL), two)
    talk.two.open_receiver("k", VOLATILE, none)

    assert [p for p, _ in heard(talk.two, all_kept)] == [b"2", b"3", b"4"]
    assert [p for p, _ in heard(talk.two, two)] == [b"3", b"4"]
    assert not none.items


@pytest.mark.parametrize("how", ["volatile", "sender closed", "session closed"])
async def test_no_history_is_left(graphflow_runner: asyncio.Runner, how: str) -> None:
    """A volatile sender keeps none, and what a latched one kept goes with it or with its session."""
    talk = Talk()
    sender = talk.one.open_sender("k", VOLATILE if how == "volatile" else LATCHED)
    sender.put(b"x", attachment=b"")
    if how == "sender closed":
        sender.close()
        sender.close()
    if how == "session closed":
        await talk.one.close()
    inbox = inbox_of(talk.two)
    talk.two.open_receiver("k", LATCHED, inbox)

    assert not inbox.items


class Answers(list[Answer | None]):
    """What came for a call, and where to send it."""

    def __call__(self, answer: Answer | None) -> None:
        self.append(answer)


async def test_a_request_is_answered(graphflow_runner: asyncio.Runner) -> None:
    """The answer comes by the loop, and None after it."""
    talk = Talk()
    requests = inbox_of(talk.two)
    talk.two.open_server("s", requests)
    answers, caller = Answers(), talk.one.open_caller("s", nothing)
    assert caller.has_server

    caller.call(b"question", b"beside", answers)
    request = requests.items.popleft()
    assert (request.payload, request.attachment) == (b"question", b"beside")
    request.reply(b"answer", b"back")
    assert answers == []
    await settle()

    assert answers == [Answer(b"answer", b"back"), None]


async def test_an_error_is_an_answer(graphflow_runner: asyncio.Runner) -> None:
    """It is told apart by `is_error`, and a second answer of the same server is not sent."""
    talk = Talk()
    requests = inbox_of(talk.two)
    talk.two.open_server("s", requests)
    answers = Answers()
    talk.one.open_caller("s", nothing).call(b"", b"", answers)

    request = requests.items.popleft()
    request.reply_error(b"no")
    request.reply(b"yes", b"")
    await settle()

    assert answers == [Answer(b"no", None, is_error=True), None]


async def test_a_call_without_servers_ends(graphflow_runner: asyncio.Runner) -> None:
    """Nobody answers, and that is said by the loop."""
    talk = Talk()
    answers, caller = Answers(), talk.one.open_caller("s", nothing)
    assert not caller.has_server

    caller.call(b"", b"", answers)
    assert answers == []
    await settle()

    assert answers == [None]


async def test_a_request_goes_to_every_server(graphflow_runner: asyncio.Runner) -> None:
    """Each may answer; None comes when the last has."""
    talk = Talk()
    first, second = inbox_of(talk.one), inbox_of(talk.two)
    talk.one.open_server("s", first)
    talk.two.open_server("s", second)
    answers = Answers()
    talk.one.open_caller("s", nothing).call(b"", b"", answers)

    second.items.popleft().reply(b"2", b"")
    await settle()
    assert answers == [Answer(b"2", b"")]
    first.items.popleft().reply(b"1", b"")
    await settle()

    assert answers == [Answer(b"2", b""), Answer(b"1", b""), None]


@slow
async def test_a_request_that_is_thrown_away_ends_the_call(graphflow_runner: asyncio.Runner) -> None:
    """A server that is gone without an answer does not leave its caller waiting."""
    talk = Talk()
    requests = inbox_of(talk.two)
    talk.two.open_server("s", requests)
    answers = Answers()
    talk.one.open_caller("s", nothing).call(b"", b"", answers)

    requests.items.clear()
    gc.collect()
    await settle()

    assert answers == [None]


async def test_no_answer_comes_after_giving_up(graphflow_runner: asyncio.Runner) -> None:
    """Neither one that is sent later nor one that is on its way."""
    talk = Talk()
    requests = inbox_of(talk.two)
    talk.two.open_server("s", requests)
    answers = Answers()
    caller = talk.one.open_caller("s", nothing)
    give_up_early = caller.call(b"", b"", answers)
    give_up_late = caller.call(b"", b"", answers)

    give_up_early()
    for request in list(requests.items):
        request.reply(b"x", b"")
    give_up_late()
    await settle()

    assert answers == []


async def test_tokens_are_told_to_watchers(graphflow_runner: asyncio.Runner) -> None:
    """Those there already, those that come and go, in order; only those that match; until closed."""
    talk = Talk()
    seen: list[tuple[str, bool]] = []
    talk.one.announce("@a/0/old")
    watcher = talk.two.watch("@a/0/**", lambda token, alive: seen.append((token, alive)))
    talk.two.watch("@a/0/exact", lambda token, alive: seen.append((f"exactly {token}", alive)))

    token = talk.one.announce("@a/0/new")
    talk.one.announce("@a/1/other")
    token.close()
    token.close()
    talk.one.announce("@a/0/exact")
    assert seen == []
    await settle()

    assert seen == [
        ("@a/0/old", True),
        ("@a/0/new", True),
        ("@a/0/new", False),
        ("@a/0/exact", True),
        ("exactly @a/0/exact", True),
    ]
    found: list[list[str]] = []
    for key in ("@a/*/new", "@a/*/exact", "@a/*/**", "@a/*/*/**"):
        talk.two.ask_tokens(key, 1.0, found.append)
    await settle()
    assert found == [[], ["@a/0/exact"], ["@a/0/old", "@a/1/other", "@a/0/exact"], []]
    watcher.close()
    talk.one.announce("@a/0/later")
    await settle()
    assert len(seen) == 5


async def test_a_closed_session_takes_everything_with_it(graphflow_runner: asyncio.Runner) -> None:
    """Its tokens, receivers, servers and watchers are gone, as when a process ends."""
    talk = Talk()
    seen: list[tuple[str, bool]] = []
    talk.one.announce("@a/0/x")
    talk.one.open_receiver("k", VOLATILE, inbox_of(talk.one))
    talk.one.open_server("s", inbox_of(talk.one))
    talk.one.watch("@a/0/**", lambda *_: None)
    talk.two.watch("@a/0/**", lambda token, alive: seen.append((token, alive)))

    await talk.one.close()
    await settle()

    assert seen == [("@a/0/x", True), ("@a/0/x", False)]
    assert not talk.network.tokens
    assert not talk.network.receivers["k"]
    assert not talk.network.servers["s"]
    assert len(talk.network.watchers) == 1
    assert not talk.two.open_caller("s", nothing).has_server


async def test_sessions_have_ids_of_their_own(graphflow_runner: asyncio.Runner) -> None:
    """Tokens tell sessions apart by them: lower-case hex."""
    talk = Talk()

    assert talk.one.zid != talk.two.zid
    assert int(talk.one.zid, 16) >= 0
    assert talk.one.zid == talk.one.zid.lower()


async def test_a_caller_is_told_of_servers(graphflow_runner: asyncio.Runner) -> None:
    """When one comes and when it goes, on the loop, until the caller is closed."""
    talk = Talk()
    seen: list[bool] = []
    caller = talk.one.open_caller("s", lambda: seen.append(caller.has_server))
    server = talk.two.open_server("s", Inbox(talk.two.bell, None, nothing))
    await settle()
    server.close()
    await settle()
    assert seen == [True, False]
    caller.close()
    talk.two.open_server("s", Inbox(talk.two.bell, None, nothing))
    await settle()
    assert seen == [True, False]


async def test_a_sender_knows_whether_it_is_wanted(graphflow_runner: asyncio.Runner) -> None:
    """By receivers of its key; one that keeps messages for later always is."""
    talk = Talk()
    plain, keeping = talk.one.open_sender("k", Qos()), talk.one.open_sender("k", LATCHED)
    assert (plain.is_wanted, keeping.is_wanted) == (False, True)
    receiver = talk.two.open_receiver("k", Qos(), Inbox(talk.two.bell, 1, nothing))
    assert plain.is_wanted
    receiver.close()
    assert not plain.is_wanted
