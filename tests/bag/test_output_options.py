"""Files that say which bags are made of a bag: what they mean, and what is wrong in them."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.bag import overrides
from graphflow.bag.output_options import is_options, read
from graphflow.bag.topic_choice import Choice
from graphflow.errors import UsageFault

ALL = Choice(all=True, all_services=True, hidden=True)


def written(folder: Path, row: str) -> Path:
    file = folder / "out.yaml"
    file.write_text(f"output_bags:\n- {{uri: new, {row}}}\n", encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("row", "choice"),
    [
        ("", ALL),
        ("storage_id: mcap, all: true", ALL),
        ("all_topics: true, all_services: false", Choice(all=True, hidden=True)),
        ("all_services: true", Choice(all_services=True, hidden=True)),
        ("topics: [chatter, /map]", Choice(topics=frozenset({"/chatter", "/map"}), hidden=True)),
        ("regex: /turtle.*, exclude: pose", Choice(regex="/turtle.*", exclude_regex="pose", hidden=True)),
        ("services: [/add], include_hidden_topics: false", Choice(services=frozenset({"/add"}))),
    ],
)
def test_which_topics(tmp_path: Path, row: str, choice: Choice) -> None:
    """The topics that are named, or all if none is."""
    [found] = read(written(tmp_path, row))
    assert (found.folder, found.choice, found.remarks) == (Path("new"), choice, [])


@pytest.mark.parametrize(
    ("row", "compression"),
    [
        ("", "zstd"),
        ("storage_preset_profile: fastwrite", "none"),
        ("storage_preset_profile: zstd_small", "zstd"),
        ("compression_mode: file, compression_format: lz4", "lz4"),
        ("compression_mode: MESSAGE, compression_format: zstd", "zstd"),
    ],
)
def test_how_it_is_packed(tmp_path: Path, row: str, compression: str) -> None:
    """In chunks, whatever ROS 2 would pack."""
    [found] = read(written(tmp_path, row))
    assert found.compression == compression


def test_the_format(tmp_path: Path) -> None:
    """MCAP, where nothing is said; SQLite's files have no chunks to pack."""
    [found] = read(written(tmp_path, ""))
    assert found.storage == "mcap"
    [found] = read(written(tmp_path, "storage_id: sqlite3, storage_preset_profile: ''"))
    assert (found.storage, found.compression) == ("sqlite3", None)


def test_times_and_sizes(tmp_path: Path) -> None:
    """Nanoseconds since 1970, the last of which belongs to it; bytes and seconds of files."""
    [found] = read(written(tmp_path, "start_time_ns: 5, end_time_ns: 7, max_bagfile_size: 9, max_bagfile_duration: 2"))
    assert (found.start_ns, found.end_ns, found.max_size, found.max_seconds) == (5, 8, 9, 2.0)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("output_bags: []", "it names no bags; write output_bags: "),
        ("[", "out.yaml:2:1: not valid YAML: did not find expected node content"),
        ("output_bags: 2020-13-45", "month must be in"),
        ("output_bags: [x]", "entry 1: it is not a mapping; write uri: NAME"),
        ("output_bags: [{uri: a}, {storage_id: mcap}]", "entry 2: it has no uri, the folder of the new bag"),
        ("output_bags: [{uri: a, storage_id: rosbag}]", "bags are written as mcap or sqlite3, not as 'rosbag'"),
        ("output_bags: [{uri: a, topics: /x}]", "topics: '/x' is not a list of names"),
        ("output_bags: [{uri: a, regex: 1}]", "regex: 1 is not a text"),
        ("output_bags: [{uri: a, all: 1}]", "all: 1 is not true or false"),
        ("output_bags: [{uri: a, start_time_ns: -1}]", "start_time_ns: -1 is not a non-negative integer"),
        ("output_bags: [{uri: a, storage_preset_profile: best}]", "'best' is not one of none, fastwrite, zstd_fast"),
        (
            "output_bags: [{uri: a, compression_mode: file, compression_format: xz}]",
            "'xz' is not available; write zstd",
        ),
        ("output_bags: [{uri: a, compression_mode: all}]", "'all' is not one of none, file, message"),
    ],
)
def test_what_is_wrong(tmp_path: Path, text: str, told: str) -> None:
    """The file is named, the entry, and what to write."""
    file = tmp_path / "out.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(UsageFault) as caught:
        read(file)
    assert str(caught.value).startswith(f"{file}:")
    assert told in str(caught.value)


def test_what_has_no_effect(tmp_path: Path) -> None:
    """Is remarked, unless rosbag2 has it; services are left out by either name."""
    row = "topcs: [/a], max_cache_size: 5, exclude_services: [/x], exclude_service_events: [/y]"
    [found] = read(written(tmp_path, row))
    assert found.remarks == ["topcs has no effect; did you mean 'topics'?"]
    assert found.choice.exclude_services == {"/x", "/y"}


def test_a_file_that_is_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is not read whole."""
    monkeypatch.setattr(overrides, "BOUND", 10)
    with pytest.raises(UsageFault, match="it has more than 10 bytes"):
        read(written(tmp_path, ""))
    with pytest.raises(UsageFault, match="to make a bag of that name, write it without"):
        read(tmp_path / "new.yaml")


def test_a_file_or_a_folder(tmp_path: Path) -> None:
    """A file, or a path with a suffix of one, has options."""
    (tmp_path / "options").touch()
    (tmp_path / "old.yaml").mkdir()
    named = {name: is_options(tmp_path / name) for name in ("options", "old.yaml", "new", "new.yaml", "new.yml")}
    assert named == {"options": True, "old.yaml": False, "new": False, "new.yaml": True, "new.yml": True}
