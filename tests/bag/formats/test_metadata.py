"""QoS profiles as bags have them; the rest of the file is looked at where bags are written and read."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from graphflow.bag.formats import metadata
from graphflow.bag.formats.metadata import as_text, plain, profiles
from graphflow.errors import BagError
from graphflow.qos import PROFILES, Durability, History, Liveliness, Qos, Reliability

SETTLED = [qos for name, qos in PROFILES.items() if name != "best_available"]


@pytest.mark.parametrize("qos", [*SETTLED, Qos(deadline_ns=1_500_000_000, lease_ns=7, lifespan_ns=10**12)])
def test_there_and_back(qos: Qos) -> None:
    """As a list, and as the text of one."""
    assert profiles([plain(qos)]) == (qos,)
    assert profiles(as_text([qos, qos])) == (qos, qos)


def test_numbers_of_older_bags() -> None:
    """Stand for words."""
    row = {"history": 2, "depth": 3, "reliability": 2, "durability": 1, "liveliness": 3}
    [qos] = profiles(yaml.safe_dump([row]))
    assert (qos.history, qos.depth) == (History.KEEP_ALL, 3)
    assert (qos.reliability, qos.durability) == (Reliability.BEST_EFFORT, Durability.TRANSIENT_LOCAL)
    assert qos.liveliness is Liveliness.MANUAL_BY_TOPIC


@pytest.mark.parametrize(
    "said",
    [None, "", 5, "[", "a: [b", {"history": 1}, "[" * 5000, b"", "- 5", [5, "x"]],
)
def test_what_is_no_profile(said: object) -> None:
    """Is left out."""
    assert profiles(said) == ()


@pytest.mark.parametrize(
    "row",
    [
        {},
        {"history": 99, "depth": -1, "reliability": "unknown", "durability": [], "liveliness": None},
        {"history": "1" * 5000, "reliability": "9" * 8},
        {"depth": 2**40, "deadline": {"sec": "x"}, "lifespan": 5, "reliability": "best_available"},
        {"deadline": {"sec": -5, "nsec": 0}, "lifespan": {"sec": 2**70, "nsec": 0}},
    ],
)
def test_what_a_profile_leaves_open(row: dict[str, object]) -> None:
    """Or says wrongly, is as in the default one."""
    assert profiles([row]) == (Qos(),)


def test_files_and_texts_that_are_too_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Such a file is refused, and such a text of profiles is cut."""
    (tmp_path / metadata.FILE).write_text("rosbag2_bagfile_information: {version: 9}\n")
    assert metadata.read(tmp_path) == {"version": 9}
    text = as_text([Qos(depth=7), Qos(depth=8)])
    monkeypatch.setattr(metadata, "BOUND", text.index("- ", 1))
    with pytest.raises(BagError, match=r"metadata\.yaml"):
        (tmp_path / metadata.FILE).write_text("rosbag2_bagfile_information: {version: 9}\n" + "#" * len(text))
        metadata.read(tmp_path)
    assert profiles(text) == (Qos(depth=7),)


def test_aliases_are_refused() -> None:
    """A few of them can expand beyond any memory."""
    with pytest.raises(ValueError, match="it has aliases"):
        metadata.loaded("a: &a [x]\nb: *a")
