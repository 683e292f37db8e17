"""Large messages between processes: through memory where all can read it, as messages of ROS 2 where one cannot."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from graphflow import EncodeError, Node, Qos
from graphflow.domain import rendezvous_endpoint
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.qos import Durability, History
from graphflow.runtime.context import Context
from graphflow.runtime.endpoints import raw, shared_memory
from graphflow.runtime.node_core import core_of
from graphflow.system import is_portable
from graphflow.testing import Graph
from graphflow.transport.config import config, open_session
from graphflow.transport.rendezvous import free_endpoint
from graphflow.wire.liveliness import Entity, Kind
from graphflow.wire.shared_memory import Reader, reader_token
from tests.cases import slow
from tests.conftest import LIMIT
from tests.until import eventually

shares = pytest.mark.skipif(is_portable(), reason="memory cannot be shared here")


WARM_UP = 255


def picture(number: int, size: int = 500_000) -> Image:
    return Image(height=1, width=size, encoding="mono8", step=size, data=np.full(size, number, np.uint8))


def stranger(publisher: Entity, session: Any) -> str:
    """The token of a subscription that is not graphflow's."""
    who = (publisher.domain, str(session.zid()), 0, 1, Kind.SUBSCRIPTION, "/", "ros")
    return Entity(*who, publisher.name, publisher.type, publisher.hash).token


def close(*declared: Any) -> None:
    for one in declared:
        one.undeclare()


class Pair:
    """A publisher and a subscription of images, each in a context, and so a session, of its own."""

    def __init__(self) -> None:
        self.heard: list[Image] = []
        self.contexts: list[Context] = []
        self.nodes: list[Node] = []
        self._before = 0
        self.talker, self.publisher = self._talker()

    def _talker(self) -> tuple[Node, Any]:
        node = Node("talker", enable_rosout=False)
        return node, node.create_publisher(Image, "images")

    async def start(self, node: Node) -> None:
        context = await Context.open()
        await core_of(node).start(context)
        self.contexts.append(context)
        self.nodes.append(node)

    async def listen(self) -> None:
        node = Node("listener", enable_rosout=False)
        node.create_subscription(Image, "images", self._hear)
        await self.start(node)

    def _hear(self, image: Image) -> None:
        if image.data[0] != WARM_UP:
            self.heard.append(image)

    @property
    def _in_memory(self) -> int:
        return int(self.publisher.statistics()["in_memory"])

    @property
    def in_memory(self) -> int:
        """Images that went through memory since all was ready."""
        return self._in_memory - self._before

    async def ready(self, readers: int) -> None:
        """Wait until so many subscriptions have the publisher's memory open: until then, images are sent."""
        await eventually(
            lambda: len(self.publisher.matched) >= readers and len(self.talker.context.readers._known) >= readers
        )

        def is_open() -> bool:
            self.publisher.publish(picture(WARM_UP))
            return self._in_memory > 0

        await eventually(is_open)
        self._before = self._in_memory

    async def deliver(self, image: Image, has_arrived: Callable[[], bool]) -> None:
        """Publish an image through memory until it has arrived: on a busy machine, Zenoh drops some messages."""

        def was_in_memory() -> bool:
            before = self._in_memory
            self.publisher.publish(image)
            return self._in_memory > before

        async with asyncio.timeout(LIMIT):
            while not has_arrived():
                await eventually(was_in_memory)  # until a new ring is open, it goes over the network
                with suppress(AssertionError):
                    await eventually(has_arrived, limit=1.0)

    def has_heard(self, number: int) -> bool:
        return bool(self.heard) and int(self.heard[-1].data[0]) == number

    async def close(self) -> None:
        for node in self.nodes:
            await core_of(node).stop()
        for context in self.contexts:
            await context.close()


@pytest.fixture
def pair(monkeypatch: pytest.MonkeyPatch, graphflow_runner: asyncio.Runner) -> Iterator[Pair]:
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", free_endpoint())
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", str(20_000 + os.getpid() % 10_000))

    async def begin() -> Pair:
        made = Pair()
        await made.start(made.talker)
        return made

    made = graphflow_runner.run(begin())
    yield made
    graphflow_runner.run(made.close())


@shares
@pytest.mark.real
class TestOverZenoh:
    async def test_large_images_are_read_from_memory(self, pair: Pair) -> None:
        """Whole, in order, and not to be written; small ones are sent, and come in order with them."""
        await pair.listen()
        await pair.ready(1)
        sizes = [500_000, 10, 500_000, 300_000, 10, 10, 550_000, 500_000]
        for number, size in enumerate(sizes):
            pair.publisher.publish(picture(number, size))
        await eventually(lambda: len(pair.heard) == len(sizes))
        assert [(m.width, int(m.data[0]), int(m.data[-1])) for m in pair.heard] == [
            (size, number, number) for number, size in enumerate(sizes)
        ]
        assert pair.in_memory == 5
        assert pair.publisher.statistics()["memory"] > 0
        with pytest.raises(ValueError, match="read-only"):
            pair.heard[0].data[0] = 1

    @slow
    async def test_images_that_are_kept_stay(self, pair: Pair) -> None:
        """More of them than the publisher has slots for, none of them changed by those that come later."""
        await pair.listen()
        await pair.ready(1)
        for number in range(60):
            pair.publisher.publish(picture(number))
            await eventually(lambda number=number: len(pair.heard) > number)  # type: ignore[misc]
        assert [set(np.unique(m.data)) for m in pair.heard] == [{number} for number in range(60)]
        assert pair.in_memory == 60

    async def test_ros_nodes_get_ordinary_messages(self, pair: Pair) -> None:
        """With one subscription of ROS 2 or another machine, all get ordinary messages; then shared memory again."""
        await pair.listen()
        await pair.ready(1)
        own = pair.publisher.entity
        settings = config("peer", connect=[rendezvous_endpoint()], listen="tcp/127.0.0.1:0")
        with open_session(settings) as session:
            got: list[bytes] = []
            subscriber = session.declare_subscriber(own.data_key, lambda sample: got.append(sample.payload.to_bytes()))
            token = session.liveliness().declare_token(stranger(own, session))
            await eventually(lambda: len(pair.publisher.matched) == 2)
            pair.publisher.publish(picture(1))
            await eventually(lambda: len(got) == len(pair.heard) == 1)
            assert got == [pair.heard[0].to_bytes()] == [picture(1).to_bytes()]
            assert pair.in_memory == 0
            close(token, subscriber)
            await eventually(lambda: len(pair.publisher.matched) == 1)
        pair.publisher.publish(picture(2))
        await eventually(lambda: len(pair.heard) == 2)
        assert pair.in_memory == 1

    async def test_a_forged_token_changes_nothing(self, pair: Pair) -> None:
        """A forged announcement would cut off another's subscription: it needs a proof."""
        own = pair.publisher.entity
        settings = config("peer", connect=[rendezvous_endpoint()], listen="tcp/127.0.0.1:0")
        with open_session(settings) as session:
            zid = str(session.zid())
            forged = f"@graphflow/{own.domain}/reader/{zid}/1/{os.getpid()}/3"
            got: list[int] = []
            subscriber = session.declare_subscriber(own.data_key, lambda sample: got.append(len(sample.payload)))
            tokens = [session.liveliness().declare_token(forged)]
            tokens.append(session.liveliness().declare_token(stranger(own, session)))
            await eventually(lambda: len(pair.publisher.matched) == 1)
            pair.publisher.publish(picture(1))
            await eventually(lambda: len(got) == 1)
            close(subscriber, *tokens)
        assert pair.in_memory == 0

    async def test_latched_images_are_sent(self, pair: Pair) -> None:
        """The network keeps them for late subscriptions."""
        node = Node("map", enable_rosout=False)
        publisher = node.create_publisher(Image, "maps", Qos(durability=Durability.TRANSIENT_LOCAL))
        await pair.start(node)
        publisher.publish(picture(3))
        late: list[Image] = []
        reader = Node("reader", enable_rosout=False)
        reader.create_subscription(Image, "maps", late.append, Qos(durability=Durability.TRANSIENT_LOCAL))
        await pair.start(reader)
        await eventually(lambda: len(late) == 1)
        assert "in_memory" not in publisher.statistics()

    async def test_recorders_read_memory_too(self, pair: Pair) -> None:
        """Subscriptions of serialized messages receive private copies."""
        node = Node("recorder", enable_rosout=False)
        got: list[bytes] = []

        def hear(payload: bytes, info: object) -> None:
            if payload[-1] != WARM_UP:
                got.append(payload)

        raw.subscribe(node, "sensor_msgs/msg/Image", "/images", hear, Qos())
        await pair.start(node)
        await pair.ready(1)
        pair.publisher.publish(picture(4))
        await eventually(lambda: len(got) == 1)
        assert type(got[0]) is bytes
        assert got[0] == picture(4).to_bytes()
        assert pair.in_memory == 1

    async def test_a_loan(self, pair: Pair) -> None:
        """The message filled in place arrives; a block that raises publishes no message."""
        await pair.listen()
        await pair.ready(1)
        with pair.publisher.loan(data=400_000) as image:
            image.header.frame_id, image.width = "camera", 400_000
            image.data[:] = 77
        with pytest.raises(ZeroDivisionError), pair.publisher.loan(data=400_000) as image:
            image.data[0] = 1 // 0
        pair.publisher.publish(picture(5))
        await eventually(lambda: len(pair.heard) == 2)
        first = pair.heard[0]
        assert (first.header.frame_id, first.width, set(np.unique(first.data))) == ("camera", 400_000, {77})
        assert pair.in_memory == 2

    @pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP], ids=["killed", "stopped"])
    async def test_a_reader_that_ends(self, pair: Pair, number: signal.Signals) -> None:
        """One that is killed or stopped while it keeps images costs neither the publisher nor others anything."""
        await pair.listen()
        process = await asyncio.create_subprocess_exec(sys.executable, "-c", KEEPER, stdout=asyncio.subprocess.PIPE)
        try:
            await pair.ready(2)
            assert process.stdout is not None
            for count in range(5):
                kept = asyncio.ensure_future(process.stdout.readline())
                await pair.deliver(picture(count), lambda: pair.has_heard(count) and kept.done())  # noqa: B023
                assert kept.result()
            process.send_signal(number)
            for count in range(5, 40):
                await pair.deliver(picture(count), lambda: pair.has_heard(count))  # noqa: B023
            assert list(dict.fromkeys(int(m.data[0]) for m in pair.heard)) == list(range(40))
        finally:
            if process.returncode is None:
                process.kill()
            await process.wait()


KEEPER = """
import asyncio
from graphflow import Node, subscription
import graphflow
from graphflow.msgs.sensor_msgs.msg import Image

class Keeper(Node):
    kept = []

    @subscription(Image, "images")
    async def keep(self, image: Image) -> None:
        if image.data[0] == 255:
            return
        self.kept.append(image)
        print(len(self.kept), flush=True)

graphflow.run(Keeper)
"""


@pytest.mark.parametrize("name", ["width", "header", "nonsense"])
async def test_what_cannot_be_lent(graph: Graph, name: str) -> None:
    """Only arrays of numbers can; the error names those that there are."""
    node = Node("talker")
    publisher = node.create_publisher(Image, "images")
    await graph.start(node)
    with pytest.raises(EncodeError, match=f"no array of numbers '{name}' to lend"), publisher.loan(**{name: 5}):
        pass


async def test_a_loan_without_memory(graph: Graph) -> None:
    """Then it is an ordinary message."""
    node, heard = Node("talker"), graph.tap(Image, "/images")
    publisher = node.create_publisher(Image, "images")
    await graph.start(node)
    with publisher.loan(data=100_000) as image:
        image.data[:] = 3
    await graph.settle()
    assert [m.data.tolist() for m in heard] == [[3] * 100_000]


def test_only_so_many_readers_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Readers beyond the limit are ignored, however many are announced."""
    monkeypatch.setattr(shared_memory, "READERS_BOUND", 2)
    session: Any = SimpleNamespace(is_neighbour=lambda *_: True)
    readers = shared_memory.Readers(session, 0)
    for eid in range(5):
        readers._token(reader_token(0, Reader("abc", eid, 1, 3)), True)
    assert readers._known == {("abc", 0), ("abc", 1)}


def test_the_queues_of_readers() -> None:
    """A subscription that keeps all has a limit, too; others keep as many as they say."""
    session: Any = SimpleNamespace(is_neighbour=lambda *_: True)
    readers = shared_memory.Readers(session, 0)
    who = [
        Entity(0, "abc", 0, n, Kind.SUBSCRIPTION, "/", "n", "/t", "a/msg/B", "", qos)
        for n, qos in enumerate((Qos(history=History.KEEP_ALL), Qos(depth=3)))
    ]
    assert readers.of(who) is None
    for entity in who:
        readers._token(reader_token(0, Reader("abc", entity.eid, 1, 3)), True)
    assert readers.of(who) == {("abc", 0): 10_000, ("abc", 1): 3}


def test_a_reader_without_proof() -> None:
    """It may be on another machine, or another user's."""
    session: Any = SimpleNamespace(is_neighbour=lambda *_: False)
    readers = shared_memory.Readers(session, 0)
    readers._token(reader_token(0, Reader("abc", 1, 1, 3)), True)
    assert readers._known == set()
