"""Playing into a graph, under the manual clock."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from graphflow import Node
from graphflow.bag.contents import Record, Topic
from graphflow.bag.player import Player, PlayOptions, offered
from graphflow.bag.reader import Bag
from graphflow.bag.topic_choice import Choice
from graphflow.errors import BagError
from graphflow.msgs.rosgraph_msgs.msg import Clock
from graphflow.msgs.std_msgs.msg import Int32, String
from graphflow.qos import BEST_AVAILABLE, DEFAULT, SENSOR_DATA, Qos
from graphflow.runtime.endpoints import raw
from graphflow.testing import Graph
from tests.bag.cast import CHATTER, LAB, LATCHED, START, THING, record, some_records, topic_of, write


class Show:
    """A player, and somebody who listens."""

    def __init__(self, graph: Graph, folder: Path, records: Iterable[Record] | None = None) -> None:
        self.graph, self.bag = graph, Bag(write(folder, records))
        self.node, self.listener = Node("player"), Node("listener")
        self.heard: list[tuple[float, str, bytes]] = []
        self.player: Player
        self.began = 0

    async def begin(self, *, listens: bool = True, **options: Any) -> Player:
        await self.graph.start(self.node, self.listener)
        for topic in self.bag.contents.topics.values() if listens else ():
            self.listen(topic)
        self.player = Player(self.node, self.bag, PlayOptions(**options))
        await self.graph.settle()
        self.began = self.node.clock.monotonic_ns()
        self.task = asyncio.create_task(self.player.run())
        await self.graph.settle()
        return self.player

    def listen(self, topic: Topic) -> None:
        def arrived(payload: bytes, _: object) -> None:
            seconds = (self.node.clock.monotonic_ns() - self.began) / 1e9
            self.heard.append((round(seconds, 3), topic.name, payload))

        raw.subscribe(self.listener, topic.type, topic.name, arrived, BEST_AVAILABLE, type_hash=topic.hash)

    def times(self, name: str = "/chatter") -> list[float]:
        return [at for at, topic, _ in self.heard if topic == name]


async def test_all_of_it_in_its_time(graph: Graph, tmp_path: Path) -> None:
    """Each message as it was recorded, at the moment at which it came."""
    show = Show(graph, tmp_path / "bag")
    player = await show.begin()
    await graph.clock.advance(3.0)
    await show.task
    expected = sorted(some_records(), key=lambda r: r.log_ns)
    assert [(topic, data) for _, topic, data in show.heard] == [(r.topic.name, r.data) for r in expected]
    assert [at for at, _, _ in show.heard] == [pytest.approx((r.log_ns - START) / 1e9) for r in expected]
    assert player.played == 41
    assert player.unheard == []


async def test_topics_that_nobody_hears(graph: Graph, tmp_path: Path) -> None:
    """They are named, as they are played."""
    show = Show(graph, tmp_path / "bag")
    player = await show.begin(listens=False)
    await graph.clock.advance(3.0)
    await show.task
    assert player.unheard == sorted({record.topic.name for record in some_records()})


@pytest.mark.parametrize("rate", [0.5, 4.0])
async def test_the_rate(graph: Graph, tmp_path: Path, rate: float) -> None:
    """Slower or faster than it was."""
    show = Show(graph, tmp_path / "bag")
    await show.begin(rate=rate)
    await graph.clock.advance(5.0)
    await show.task
    assert show.times() == [pytest.approx(n / 10 / rate, abs=1e-3) for n in range(20)]


async def test_a_rate_that_changes(graph: Graph, tmp_path: Path) -> None:
    """From then on."""
    show = Show(graph, tmp_path / "bag")
    player = await show.begin()
    await graph.clock.advance(1.0)
    player.rate = 10.0
    await graph.clock.advance(1.0)
    await show.task
    assert show.times()[:11] == [pytest.approx(n / 10) for n in range(11)]
    assert show.times()[-1] < 1.15


async def test_a_part_of_it(graph: Graph, tmp_path: Path) -> None:
    """Some seconds left out, and only so many played; some topics."""
    show = Show(graph, tmp_path / "bag")
    await show.begin(start_offset=0.5, duration=1.0, choice=Choice(topics=frozenset({"/chatter"})))
    await graph.clock.advance(3.0)
    await show.task
    assert [String.from_bytes(data).data for _, _, data in show.heard] == [f"hello {n}" for n in range(5, 15)]
    assert show.times()[0] == 0.0


async def test_up_to_a_time(graph: Graph, tmp_path: Path) -> None:
    """Messages at that very time are played, later ones are not."""
    show = Show(graph, tmp_path / "bag")
    await show.begin(until_ns=START + 500_000_000, choice=Choice(topics=frozenset({"/chatter"})))
    await graph.clock.advance(3.0)
    await show.task
    assert show.times() == [pytest.approx(n / 10) for n in range(6)]


async def test_over_and_over(graph: Graph, tmp_path: Path) -> None:
    """Until it is stopped."""
    show = Show(graph, tmp_path / "bag")
    await show.begin(loop=True, delay=1.0)
    await graph.clock.advance(0.9)
    assert show.heard == []
    await graph.clock.advance(10.0)
    assert len(show.times("/map")) >= 5
    assert not show.task.done()
    show.task.cancel()


async def test_a_loop_of_nothing(graph: Graph, tmp_path: Path) -> None:
    """Is refused; one of a single message goes on, and leaves others their time."""
    show = Show(graph, tmp_path / "bag", [record(CHATTER, String(data="once"), 0.0)])
    with pytest.raises(BagError, match="no message of /chatter from 100 s on; it lasts 0 s"):
        await show.begin(loop=True, start_offset=100.0)
    again = asyncio.create_task(Player(show.node, show.bag, PlayOptions(loop=True)).run())
    await graph.clock.advance(1.0)
    assert 50 < len(show.heard) <= 101
    again.cancel()


async def test_pausing_and_stepping(graph: Graph, tmp_path: Path) -> None:
    """A step sends the next message; what follows goes on from where it was."""
    show = Show(graph, tmp_path / "bag")
    player = await show.begin(is_paused=True)
    await graph.clock.advance(5.0)
    assert show.heard == []
    player.step()
    await graph.clock.advance(0.1)
    assert len(show.heard) == 1
    player.step(3)
    await graph.clock.advance(0.1)
    assert len(show.heard) == 4
    player.is_paused = False
    await graph.clock.advance(3.0)
    await show.task
    assert player.played == 41
    chatter = show.times()[2:]
    assert chatter[-1] - chatter[0] == pytest.approx(1.7, abs=0.03)


async def test_pausing_on_the_way(graph: Graph, tmp_path: Path) -> None:
    """The time of the pause is not made up for."""
    show = Show(graph, tmp_path / "bag")
    player = await show.begin()
    await graph.clock.advance(0.95)
    player.is_paused = True
    await graph.clock.advance(10.0)
    assert len(show.times()) == 10
    player.is_paused = False
    await graph.clock.advance(0.02)
    assert len(show.times()) <= 11
    await graph.clock.advance(2.0)
    await show.task
    assert player.played == 41


async def test_seeking(graph: Graph, tmp_path: Path) -> None:
    """Forward and back."""
    show = Show(graph, tmp_path / "bag")
    player = await show.begin(choice=Choice(topics=frozenset({"/chatter"})))
    await graph.clock.advance(0.25)
    player.seek(START + 1_500_000_000)
    await graph.clock.advance(0.25)
    player.seek(START)
    await graph.clock.advance(0.15)
    said = [String.from_bytes(data).data.split()[1] for _, _, data in show.heard]
    assert said == ["0", "1", "2", "15", "16", "17", "0", "1"]
    show.task.cancel()


async def test_other_names(graph: Graph, tmp_path: Path) -> None:
    """Topics can be played to others."""
    show = Show(graph, tmp_path / "bag")
    show.listen(CHATTER._replace(name="/news"))
    player = await show.begin(remaps={"/chatter": "/news"}, choice=Choice(topics=frozenset({"/chatter"})))
    assert player.topics == ["/news"]
    show.task.cancel()


async def test_the_time_of_the_bag(graph: Graph, tmp_path: Path) -> None:
    """Is published, as often as asked for."""
    show = Show(graph, tmp_path / "bag")
    seen: list[float] = []
    show.listener.create_subscription(
        Clock, "/clock", lambda m: seen.append(m.clock.sec - START // 10**9 + m.clock.nanosec / 1e9), SENSOR_DATA
    )
    await show.begin(clock_hz=10.0, rate=2.0)
    await graph.clock.advance(0.95)
    assert len(seen) == 10
    assert seen[-1] == pytest.approx(1.8, abs=0.1)
    show.task.cancel()


GOAL = Topic("/fibonacci/_action/send_goal", "std_msgs/msg/String")
EVENTS = Topic("/add/_service_event", "std_msgs/msg/String")


@pytest.mark.parametrize(
    ("topic", "message"),
    [
        (GOAL, "would make nodes act; to play it: --allow-commands"),
        (EVENTS, "would make nodes act; to play it: --allow-commands"),
        (Topic("@graphflow/1/look/ab", "std_msgs/msg/String"), "is not a name"),
        (Topic("/a/*/b", "std_msgs/msg/String"), "is not a name"),
        (Topic("/a//b", "std_msgs/msg/String"), "is not a name"),
        (Topic("/a", "nowhere_msgs/msg/A"), "the bag has no definition of it"),
        (Topic("/a", "std_msgs/msg/String", encoding="json"), "is serialized as 'json', not as CDR"),
    ],
)
async def test_what_is_not_played(graph: Graph, tmp_path: Path, topic: Topic, message: str) -> None:
    """Commands, unless they are asked for, and what is no topic."""
    show = Show(graph, tmp_path / "bag", [record(topic, String(data="x"), 0.0), record(CHATTER, String(), 1.0)])
    await graph.start(show.node)
    player = Player(show.node, show.bag, PlayOptions())
    assert player.topics == ["/chatter"]
    [refused] = player.refused
    assert message in refused


async def test_commands_that_are_asked_for(graph: Graph, tmp_path: Path) -> None:
    """Are played."""
    show = Show(graph, tmp_path / "bag", [record(GOAL, String(data="x"), 0.0)])
    await graph.start(show.node)
    assert Player(show.node, show.bag, PlayOptions(allows_commands=True)).topics == [GOAL.name]


async def test_a_new_name_that_is_a_command(graph: Graph, tmp_path: Path) -> None:
    """It is what it is played to that counts."""
    show = Show(graph, tmp_path / "bag", [record(CHATTER, String(), 0.0)])
    await graph.start(show.node)
    with pytest.raises(BagError, match="there is nothing to play: /chatter would make nodes act"):
        Player(show.node, show.bag, PlayOptions(remaps={"/chatter": GOAL.name}))


async def test_a_new_name_of_another_type(graph: Graph, tmp_path: Path) -> None:
    """It is refused, whether the bag or the graph has that topic; one of the same type is not."""
    show = Show(graph, tmp_path / "bag")
    await graph.start(show.node)
    show.node.create_publisher(Int32, "/number", 1)
    await graph.settle()
    for taken in ("/count", "/number"):
        text = f"/chatter is of type std_msgs/msg/String, and {taken} of type std_msgs/msg/Int32; give it another name"
        with pytest.raises(BagError, match=text):
            Player(show.node, show.bag, PlayOptions(remaps={"/chatter": taken}))
    Player(show.node, show.bag, PlayOptions(remaps={"/chatter": "/map", "/count": "/number"}))


async def test_nothing_of_it(graph: Graph, tmp_path: Path) -> None:
    """Says what there is."""
    show = Show(graph, tmp_path / "bag")
    await graph.start(show.node)
    with pytest.raises(BagError, match="there is nothing to play: no topic /x; there is /chatter, /count, /map"):
        Player(show.node, show.bag, PlayOptions(choice=Choice(topics=frozenset({"/x"}))))


async def test_a_type_that_is_nowhere_installed(graph: Graph, tmp_path: Path) -> None:
    """Is played under its name and hash, of which the bag knows the one or both."""
    show = Show(graph, tmp_path / "bag", [record(LAB, THING, 0.0)])
    await graph.start(show.node)
    player = Player(show.node, show.bag, PlayOptions())
    [publisher] = player._publishers.values()
    assert publisher.entity is not None
    assert publisher.entity.hash.startswith("RIHS01_")


@pytest.mark.parametrize(
    ("said", "qos"),
    [
        ((), DEFAULT),
        ((LATCHED,), LATCHED),
        ((LATCHED, DEFAULT), Qos(depth=10)),
        ((SENSOR_DATA, DEFAULT), Qos(depth=10)),
        ((SENSOR_DATA,), SENSOR_DATA),
        ((Qos(depth=100_000),), Qos(depth=1000)),
        ((Qos(deadline_ns=5, lease_ns=7),), Qos()),
    ],
)
def test_with_what_it_is_played(said: tuple[Qos, ...], qos: Qos) -> None:
    """The profile suits all recorded subscriptions; deadlines and lifespans are not offered."""
    assert offered(topic_of("/a", Int32)._replace(qos=said)) == qos


async def test_steps_that_were_not_taken(graph: Graph, tmp_path: Path) -> None:
    """Are forgotten when it goes on."""
    show = Show(graph, tmp_path / "bag")
    player = await show.begin(is_paused=True)
    player.step(30)
    player.is_paused = False
    await graph.clock.advance(0.5)
    player.is_paused = True
    await graph.clock.advance(0.1)
    before = player.played
    await graph.clock.advance(5.0)
    assert player.played == before < 20
    show.task.cancel()


async def test_the_time_between_two_messages(graph: Graph, tmp_path: Path) -> None:
    """Passes, too."""
    records = [record(CHATTER, String(data=word), at) for word, at in (("a", 0.0), ("b", 10.0))]
    show = Show(graph, tmp_path / "bag", records)
    player = await show.begin()
    await graph.clock.advance(5.0)
    assert (player.now_ns - START) / 1e9 == pytest.approx(5.0, abs=0.05)
    show.task.cancel()


async def test_a_burst(graph: Graph, tmp_path: Path) -> None:
    """So many messages at once, or all."""
    show = Show(graph, tmp_path / "bag")
    player = await show.begin(is_paused=True)
    show.task.cancel()
    for count in (5, 0):
        task = asyncio.create_task(player.burst(count))
        await graph.clock.advance(0.001)
        await task
        await graph.settle()
        assert {at for at, _, _ in show.heard[:5]} <= {0.0, 0.001}
    assert player.played == 5 + 41  # the listener's queue is shorter


async def test_other_profiles(graph: Graph, tmp_path: Path) -> None:
    """In place of those in the bag."""
    show = Show(graph, tmp_path / "bag")
    player = await show.begin(qos={"/chatter": SENSOR_DATA})
    assert player._publishers["/chatter"].qos == SENSOR_DATA
    assert player._publishers["/count"].qos == DEFAULT


@pytest.mark.parametrize(
    ("options", "count"), [({"clocks_all": True}, 41), ({"clock_topics": frozenset({"/count"})}, 20)]
)
async def test_time_with_messages(graph: Graph, tmp_path: Path, options: dict[str, Any], count: int) -> None:
    """The time of each message, before it."""
    show = Show(graph, tmp_path / "bag")
    tap = graph.tap(Clock, "/clock")
    await show.begin(**options)
    await graph.clock.advance(3.0)
    await show.task
    assert len(tap.messages) == count
    last = tap.messages[-1].clock
    assert last.sec * 10**9 + last.nanosec == round(show.heard[-1][0] * 10**9) + START
