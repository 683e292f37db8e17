"""Publishers that keep messages, seen across a network that tells of them before they can be reached."""

from __future__ import annotations

import asyncio

import pytest
import zenoh

from graphflow.qos import Durability, Qos
from graphflow.transport.inbox import Inbox
from graphflow.transport.rendezvous import free_endpoint
from graphflow.transport.zenoh import ZenohSession
from tests.conftest import LIMIT

pytestmark = pytest.mark.real


def test_a_publisher_that_cannot_be_asked_yet_is_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """What it keeps arrives although the question at its sign of life found nobody."""
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", free_endpoint())

    async def heard() -> tuple[bytes, list[str]]:
        session = ZenohSession(asyncio.get_running_loop())
        asked: list[str] = []
        arrived = asyncio.Event()
        inbox = Inbox(session.bell, 10, arrived.set)

        def answer(query: zenoh.Query) -> None:
            asked.append(str(query.parameters))
            with query:
                query.reply("0/map", b"kept")

        receiver = session.open_receiver("0/map", Qos(depth=5, durability=Durability.TRANSIENT_LOCAL), inbox)
        publisher = f"0/map/@adv/pub/{'a' * 32}/7/_"
        session.raw.liveliness().declare_token(publisher)
        await asyncio.sleep(0.1)  # Zenoh's own subscriber asks meanwhile, and nothing tells when it has
        session.raw.declare_queryable(publisher, answer)
        async with asyncio.timeout(LIMIT):
            await arrived.wait()
        receiver.close()
        await session.close()
        return session.read(inbox.items[0])[0], asked

    payload, asked = asyncio.run(heard())

    assert payload == b"kept"
    assert [parameters.partition(";")[0] for parameters in asked] == [f"_sn=..{1 << 30}"]
