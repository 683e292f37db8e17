"""What a call carries of those who wait for it, and who of them holds every slot that its answer needs."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from graphflow.deadlock.chains import Chains
from graphflow.executor.groups import HandlerGroup
from graphflow.executor.ledger import PendingCall
from graphflow.executor.runner import Runner
from graphflow.testing.clock import settle
from graphflow.wire import attachment, chain
from tests.deadlock.stage import Stage, begin

ZID, GID = "0123456789abcdef0123", b"\7" * 16


class Item:
    """A request with an attachment."""

    def __init__(self, chain: bytes = b"") -> None:
        self.attachment = attachment.pack(1, 0, b"\1" * 16) + chain


class Play:
    """Handlers of one node that make a call each, and wait for its answer."""

    def __init__(self) -> None:
        self.stage = Stage()
        self.chains = Chains(self.stage.ledger, ZID)
        self.actor = self.stage.actor()
        self.carried: list[bytes] = []
        self.numbers = iter(range(1, 100))

    async def call(self, item: Any) -> None:
        future = self.stage.loop.create_future()
        with self.pending(future) as call:
            self.carried.append(self.chains.of(call))
            await future

    def pending(self, future: asyncio.Future[Any]) -> PendingCall:
        return self.stage.ledger.call(future, GID, next(self.numbers), "/add", 0, None)

    def caller(self, group: HandlerGroup | None = None, kind: Any = "timer", **options: Any) -> Runner:
        return self.stage.handler(self.actor, "ask", self.call, group, kind=kind, **options)

    def server(self, group: HandlerGroup | None = None, **options: Any) -> Runner:
        return self.stage.handler(self.actor, "add", group=group, kind="service", **options)

    def asked(self) -> bytes:
        """The attachment of the last of those calls."""
        return attachment.pack(1, 0, GID) + self.carried[-1]


# what a call carries


@pytest.mark.parametrize("kind", ["timer", "subscription", "action", "service"])
async def test_a_call_that_a_handler_makes(graphflow_runner: asyncio.Runner, kind: str) -> None:
    """It carries one hop: the process, the run, and the call that this waits for."""
    play = Play()
    caller = play.caller(kind=kind)
    await begin(caller, Item())

    [run] = caller.active
    assert chain.hops(play.carried[0]) == [chain.Hop(chain.process_of(ZID), run.number, GID, 1)]


async def test_a_call_that_a_service_makes_for_its_caller(graphflow_runner: asyncio.Runner) -> None:
    """It carries whoever waits for the service, too; that a message carries a chain means nothing."""
    play = Play()
    before = chain.extended(b"", chain.Hop(b"elsewher", 3, b"\2" * 16, 4))
    for kind, count in (("service", 2), ("subscription", 1)):
        await begin(play.caller(kind=kind), Item(before))
        assert len(chain.hops(play.carried[-1])) == count
    assert chain.hops(play.carried[0])[0].run == 3


async def test_a_call_that_no_handler_waits_for(graphflow_runner: asyncio.Runner) -> None:
    """What a task makes, also one that a handler has started, carries nothing: the handler may go on without it."""
    play = Play()

    async def starts(item: Any) -> None:
        await asyncio.create_task(play.call(item))

    runner = play.stage.handler(play.actor, "start", starts)
    await begin(runner, Item())

    assert play.carried == [b""]
    play.carried.clear()
    task = asyncio.create_task(play.call(None))
    await settle()
    assert play.carried == [b""]
    task.cancel()


# who holds every slot


async def test_the_only_slot_is_held_by_who_asks(graphflow_runner: asyncio.Runner) -> None:
    """The server's group is full of the run that waits for this very request."""
    play = Play()
    group = HandlerGroup(1)
    caller, server = play.caller(group), play.server(group)
    await begin(caller, Item())

    assert play.chains.holders(server, play.asked()) == list(caller.active)


async def test_a_handler_that_asks_itself(graphflow_runner: asyncio.Runner) -> None:
    """A handler in no group, or in one without a limit that it queues behind, has one slot."""
    play = Play()
    for is_serial, is_found in ((None, True), (False, False)):
        server = play.caller(kind="service", is_serial=is_serial)
        await begin(server, Item())
        assert play.chains.holders(server, play.asked()) == (list(server.active) if is_found else [])


@pytest.mark.parametrize(
    ("group", "is_found"),
    [
        (HandlerGroup(1), True),
        (HandlerGroup(2), False),
        (HandlerGroup(None), False),
        (HandlerGroup(1, when_full="cancel_running"), False),
    ],
)
async def test_a_slot_that_may_come_free(graphflow_runner: asyncio.Runner, group: HandlerGroup, is_found: bool) -> None:
    """Nobody is named where another slot is left, or where newer work ends what runs."""
    play = Play()
    caller, server = play.caller(group), play.server(group)
    await begin(caller, Item())

    assert bool(play.chains.holders(server, play.asked())) is is_found


async def test_all_slots_are_held_by_one_chain(graphflow_runner: asyncio.Runner) -> None:
    """With two slots, the chain has to have both who hold them; one who waits for something else may go on."""
    play = Play()
    group = HandlerGroup(2)
    first, second, server = play.caller(group), play.caller(group, kind="service"), play.server(group)
    await begin(first, Item())
    await begin(second, Item(play.carried[0]))
    both = play.asked()
    alone = attachment.pack(1, 0, GID) + chain.extended(b"", chain.hops(play.carried[-1])[1])

    assert {run.number for run in play.chains.holders(server, both)} == {
        run.number for runner in (first, second) for run in runner.active
    }
    assert play.chains.holders(server, alone) == []


async def test_who_has_given_up(graphflow_runner: asyncio.Runner) -> None:
    """A run that does not wait for the call any more, whatever its chain says, will give its slot back."""
    play = Play()
    group = HandlerGroup(1)
    caller, server = play.caller(group), play.server(group)
    await begin(caller, Item())
    play.stage.ledger.calls.clear()

    assert play.chains.holders(server, play.asked()) == []


@pytest.mark.parametrize("change", ["process", "run", "gid", "sequence", "none"])
async def test_chains_that_are_not_true(graphflow_runner: asyncio.Runner, change: str) -> None:
    """A hop of another process, run or call proves nothing here; neither do bytes that are no chain."""
    play = Play()
    group = HandlerGroup(1)
    caller, server = play.caller(group), play.server(group)
    await begin(caller, Item())
    [hop] = chain.hops(play.carried[0])
    others: dict[str, Any] = {"process": b"\0" * 8, "run": hop.run + 1, "gid": b"\0" * 16, "sequence": 99}
    told = b"noise" if change == "none" else chain.extended(b"", hop._replace(**{change: others[change]}))

    assert play.chains.holders(server, attachment.pack(1, 0, GID) + told) == []


async def test_what_a_call_has_come_through(graphflow_runner: asyncio.Runner) -> None:
    """The runs behind the one that holds the slot: those of this process by number, those of others counted."""
    play = Play()
    group = HandlerGroup(1)
    caller, middle, server = play.caller(group), play.caller(kind="service"), play.server(group)
    await begin(caller, Item(chain.extended(b"", chain.Hop(b"waits on", 1, GID, 9))))
    await begin(middle, Item(chain.extended(play.carried[0], chain.Hop(b"elsewher", 3, GID, 4))))

    [holder], [between] = play.chains.holders(server, play.asked()), middle.active
    assert play.chains.between([holder], play.asked()) == ([between.number], 1)
