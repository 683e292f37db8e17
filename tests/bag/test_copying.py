"""Bags made of bags."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from graphflow.bag import copying
from graphflow.bag.copying import beside, copy, joined, times
from graphflow.bag.reader import Bag
from graphflow.bag.topic_choice import Choice
from graphflow.bag.writer import BagWriter
from graphflow.errors import BagError
from graphflow.msgs.std_msgs.msg import Int32
from tests.bag.cast import COUNT, START, record, some_records, write

ALL = Choice(all=True, hidden=True, all_services=True)


def made(bags: list[Bag], folder: Path, choice: Choice = ALL, **options: Any) -> Bag:
    remaps = options.pop("remaps", {})
    with BagWriter(folder) as writer:
        copy(bags, writer, joined(bags, choice, remaps), **options)
    return Bag(folder)


def test_all_of_it(tmp_path: Path) -> None:
    """Topics, hashes, QoS, numbers and times stay as they are."""
    bag = Bag(write(tmp_path / "a"))
    assert list(made([bag], tmp_path / "b").records()) == list(bag.records())


def test_some_of_it(tmp_path: Path) -> None:
    """Topics under other names, and a time."""
    bag = Bag(write(tmp_path / "a"))
    wanted = Choice(topics=frozenset({"/count"}))
    start_ns, end_ns = times([bag], 0.5, 1.0)
    cut = made([bag], tmp_path / "b", wanted, remaps={"/count": "/n"}, start_ns=start_ns, end_ns=end_ns)
    assert cut.contents.counts == {"/n": 5}
    assert [r.log_ns - START for r in cut.records()] == [550_000_000 + n * 100_000_000 for n in range(5)]


def test_how_far_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Told now and then, with the number of all messages that were asked for, if no time was."""
    monkeypatch.setattr(copying, "TOLD_EVERY", 15)
    bags = [Bag(write(tmp_path / "a")), Bag(write(tmp_path / "b"))]
    told: list[tuple[int, int | None]] = []
    made(bags, tmp_path / "c", Choice(topics=frozenset({"/count"})), on_progress=lambda *said: told.append(said))
    made(bags, tmp_path / "d", end_ns=START + 1, on_progress=lambda *said: told.append(said))
    assert told == [(0, 40), (15, 40), (30, 40), (0, None)]


def test_several(tmp_path: Path) -> None:
    """In the order of their times."""
    records = some_records()
    bags = [Bag(write(tmp_path / "a", records[::2])), Bag(write(tmp_path / "b", records[1::2]))]
    whole = made(bags, tmp_path / "c")
    assert [r.data for r in whole.records()] == [r.data for r in sorted(records, key=lambda r: r.log_ns)]


def test_one_topic_of_two_types(tmp_path: Path) -> None:
    """Cannot be in one bag."""
    other = record(COUNT._replace(name="/chatter"), Int32(), 0.0)
    bags = [Bag(write(tmp_path / "a")), Bag(write(tmp_path / "b", [other]))]
    with pytest.raises(BagError, match="/chatter is of type std_msgs/msg/Int32, and of std_msgs/msg/String in another"):
        made(bags, tmp_path / "c")


def test_one_topic_of_two_encodings(tmp_path: Path) -> None:
    """Their bytes are read in different ways, though the type is one."""
    other = record(COUNT._replace(encoding="json"), b'{"data": 1}', 0.0)
    bags = [Bag(write(tmp_path / "a")), Bag(write(tmp_path / "b", [other]))]
    with pytest.raises(BagError, match="/count is of type std_msgs/msg/Int32, and of another definition of it"):
        made(bags, tmp_path / "c")


def test_a_topic_whose_hash_one_bag_lacks(tmp_path: Path) -> None:
    """Older distributions write none: the two are one topic, with the hash of the other bag; a wrong one is not."""
    plain = record(COUNT._replace(hash=""), Int32(data=1), 0.0)
    first, second = Bag(write(tmp_path / "a", [plain])), Bag(write(tmp_path / "b"))
    whole = made([first, second], tmp_path / "c")
    assert whole.contents.topics[COUNT.name].hash == COUNT.hash
    assert whole.contents.counts[COUNT.name] == 1 + second.contents.counts[COUNT.name]
    wrong = Bag(write(tmp_path / "d", [record(COUNT._replace(hash="RIHS01_" + "0" * 64), Int32(), 0.0)]))
    with pytest.raises(BagError, match="and of another definition of it in another"):
        made([second, wrong], tmp_path / "e")


def test_times(tmp_path: Path) -> None:
    """From the beginning of the first bag, or since 1970."""
    bags = [Bag(write(tmp_path / "a"))]
    assert times(bags, None, None) == (0, None)
    assert times(bags, 1.5, 2.0) == (START + 1_500_000_000, START + 2_000_000_000)
    assert times(bags, START / 1e9, None) == (START, None)
    assert beside(Path("x/bag"), "cut") == Path("x/bag_cut")
    assert beside(Path("x/bag_0.mcap"), "cut") == Path("x/bag_0_cut")


def test_a_new_name_that_is_taken(tmp_path: Path) -> None:
    """By a topic of another type."""
    bag = Bag(write(tmp_path / "a"))
    with pytest.raises(BagError, match="/count is of type std_msgs/msg/Int32, and of std_msgs/msg/String in another"):
        made([bag], tmp_path / "b", remaps={"/count": "/chatter"})
