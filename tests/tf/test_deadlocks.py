"""Waits for transforms that can never arrive, and those that look alike."""

from __future__ import annotations

import pytest

from graphflow import Client, Group, Node, service, task, timer
from graphflow.msgs.std_srvs.srv import Empty
from graphflow.testing import Graph
from graphflow.tf import Transform, Transforms
from tests.flat import flat

Caplog = pytest.LogCaptureFixture


class Excluded(Node):
    """Its group runs one handler at a time, and the one that waits keeps the other out."""

    tf = Transforms()
    one = Group(1)

    @timer(0.5, group=one)
    async def look(self) -> None:
        await self.tf.lookup("odom", "base_link", timeout=None)

    @timer(0.8, group=one)
    async def odometry(self) -> None:
        self.tf.send(Transform.of("odom", "base_link"))


class Stopped(Node):
    """Sends for a while; the lookup wants a later time than it will ever send."""

    tf = Transforms()
    one = Group(1)
    frame = "odom"

    @timer(0.05, group=one)
    async def odometry(self) -> None:
        self.tf.send(Transform.of(self.frame, "base_link"))

    @timer(1.0, group=one)
    async def look(self) -> None:
        await self.tf.lookup("odom", "base_link", at=self.clock.now(), timeout=None)


class Itself(Node):
    """Waits for what it sends only then."""

    tf = Transforms()

    @task
    async def run(self) -> None:
        await self.tf.lookup("map", "base_link", timeout=None)
        self.tell()

    def tell(self) -> None:
        self.tf.send(Transform.of("map", "base_link"))


class Mapper(Node):
    """Waits for another node's transform, and sends one of its own then."""

    tf = Transforms()

    @timer(0.5)
    async def scanned(self) -> None:
        await self.tf.lookup("odom", "base_link", timeout=None)
        self.tf.send(Transform.of("map", "odom"))


class Computed(Node):
    """The frames that it sends are no constants."""

    tf = Transforms()
    frames = ("map", "base_link")

    @task
    async def run(self) -> None:
        await self.tf.lookup("map", "base_link", timeout=None)
        self.tf.send(Transform.of(*self.frames))


class Helped(Node):
    """Another handler sends it, and is free."""

    tf = Transforms()
    late = 0

    @task
    async def run(self) -> None:
        await self.tf.lookup("map", "base_link", timeout=None)
        self.tf.send(Transform.of("map", "base_link"))

    @timer(2.0)
    async def tick(self) -> None:
        self.tf.send(Transform.of("map", "base_link"))


class Passing(Node):
    """Its transforms are known to other code, which may send any."""

    tf = Transforms()

    async def on_start(self) -> None:
        self.helpers = [self.tf]

    @task
    async def run(self) -> None:
        await self.tf.lookup("map", "base_link", timeout=None)
        self.tf.send(Transform.of("map", "base_link"))


def deadlocks(caplog: Caplog) -> list[str]:
    return [flat(record.getMessage()) for record in caplog.records if "DEADLOCK: " in record.getMessage()]


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        (Excluded, "waits for the transform odom -> base_link, and odometry, which sends it, is kept out"),
        (Stopped, "waits for the transform odom -> base_link, and odometry, which sends it, is kept out"),
        (Itself, "task run of /itself waits for the transform map -> base_link"),
    ],
)
async def test_transforms_that_never_come(graph: Graph, caplog: Caplog, kind: type[Node], text: str) -> None:
    """The report names the handler that sends them, and why it cannot."""
    await graph.start(kind())
    await graph.clock.advance(3.0)
    [report] = deadlocks(caplog)
    assert report.startswith("LIKELY DEADLOCK: ")
    assert text in report


@pytest.mark.parametrize("kind", [Mapper, Computed, Helped, Passing])
async def test_waits_that_may_end(graph: Graph, caplog: Caplog, kind: type[Node]) -> None:
    """Another node may still start, or other code send; the log says what a lookup lacks."""
    await graph.start(kind())
    await graph.clock.advance(1.9 if kind is Helped else 6.0)
    assert deadlocks(caplog) == []
    if kind is not Helped:
        assert "a lookup waits for 5 s so far: " in caplog.text


class Localizer(Node):
    """Answers once it knows where it is."""

    tf = Transforms()

    @service(Empty, "localize")
    async def localize(self, request: Empty.Request) -> Empty.Response:
        await self.tf.lookup("map", "base_link", timeout=None)
        return Empty.Response()


class Asking(Node):
    """Sends where the robot is once the localizer has answered."""

    tf = Transforms(listen=False)
    localize = Client(Empty, "localize")

    @task
    async def run(self) -> None:
        await self.localize.call(Empty.Request(), timeout=None)
        self.tf.send(Transform.of("map", "base_link"))


async def test_a_ring_of_a_call_and_a_transform(graph: Graph, caplog: Caplog) -> None:
    """One node waits for an answer, the other for the transform that follows it."""
    await graph.start(Localizer(), Asking())
    await graph.clock.advance(3.0)
    [report] = deadlocks(caplog)
    assert "2 callbacks wait for each other in a ring" in report
    assert "service localize of /localizer waits for the transform map -> base_link" in report
