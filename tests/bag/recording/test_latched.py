"""Messages that are repeated at the beginning of files and snapshots."""

from __future__ import annotations

from pathlib import Path

from graphflow.bag.reader import Bag
from graphflow.bag.recording.latched import LatchedMessages, Repeats
from graphflow.msgs.std_msgs.msg import Int32, String
from tests.bag.cast import CHATTER, COUNT, MAP, START, record, write


def test_how_many() -> None:
    """By name, else by the durability of publishers."""
    repeats = Repeats({"/chatter": 3, "/map": 2}, 1)
    assert [repeats.count(topic) for topic in (CHATTER, MAP, COUNT)] == [3, 2, 0]
    assert Repeats(latched=5).count(MAP) == 5
    assert Repeats().count(MAP) == 0


def test_what_is_kept() -> None:
    """The last ones, with the time of what follows; those that follow anyway are not repeated."""
    kept = LatchedMessages(Repeats(latched=2))
    maps = [record(MAP, String(data=text), n) for n, text in enumerate("abc")]
    for one in [*maps, record(COUNT, Int32(), 3)]:
        kept.put(one)
    assert list(kept.before(9)) == [one._replace(log_ns=9) for one in maps[1:]]
    assert list(kept.before(9, maps[:1])) == [maps[2]._replace(log_ns=9)]
    assert list(kept.before(9, maps)) == []


def test_files(tmp_path: Path) -> None:
    """Each but the first begins with them; they are no reason for the next file, and files do not overlap in time."""
    records = [record(MAP, String(data="x" * 500), 0)]
    records += [record(COUNT, Int32(data=n), n) for n in range(1, 30)]
    folder = write(tmp_path / "bag", records, max_size=80, repeats=Repeats(latched=1))
    bag = Bag(folder)
    assert [part.contents.counts["/map"] for part in bag.parts] == [1] * len(bag.parts)
    assert bag.contents.counts == {"/map": len(bag.parts), "/count": 29}
    assert 3 < len(bag.parts) < 10
    for file, before in zip(bag.files[1:], bag.files, strict=False):
        first, second = list(file.records())[:2]
        assert (first.topic.name, first.log_ns) == ("/map", second.log_ns)
        assert file.contents.start_ns > before.contents.end_ns >= START
