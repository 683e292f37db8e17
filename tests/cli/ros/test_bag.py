"""`graphflow bag` on existing bags: info, echo, recover, convert, filter, merge; and wrong arguments."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from graphflow.bag.reader import Bag
from tests.bag.cast import some_records, write
from tests.conftest import Machine


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a bag called `bag`."""
    write(tmp_path / "bag")
    return tmp_path


def test_info(machine: Machine, folder: Path) -> None:
    """`info` is printed as in ROS 2, of a folder and of a file, as names only, and as JSON."""
    for path in ("bag", "bag/bag_0.mcap"):
        assert "Topic: /chatter | Type: std_msgs/msg/String | Count: 20 |" in machine.look(
            "bag", "info", path, cwd=folder
        )
    assert machine.look("bag", "info", "bag", "-t", cwd=folder).split() == ["/chatter", "/count", "/map"]
    assert json.loads(machine.look("bag", "info", "bag", "--json", cwd=folder))["messages"] == 41
    assert "  | string data" in machine.look("bag", "info", "-v", "bag", cwd=folder)


def test_echo(machine: Machine, folder: Path) -> None:
    """Messages are printed as by `topic echo`, with topic and time, or as lines of JSON or CSV."""
    text = machine.look("bag", "echo", "bag", "/count", "-n", "2", cwd=folder)
    assert text == "# /count 1700000000.050000000\ndata: 0\n---\n# /count 1700000000.150000000\ndata: 1\n---\n"
    assert machine.look("bag", "echo", "bag", "--csv", "-n", "1", cwd=folder) == "1700000000000000000,/map,map\n"
    line = json.loads(machine.look("bag", "echo", "bag", "chatter", "--json", "-n", "1", cwd=folder))
    assert line == {"topic": "/chatter", "time_ns": 1_700_000_000_000_000_000, "message": {"data": "hello 0"}}


def test_bags_of_bags(machine: Machine, folder: Path) -> None:
    """Bags are filtered, converted, merged and recovered; each verb reports the new bag."""
    text = machine.look("bag", "filter", "bag", "--topics", "/count", "--start", "1", cwd=folder)
    assert text.startswith("bag_filtered: 10 messages of 1 topic, ")
    machine.look("bag", "filter", "bag", "-x", "count", "-m", "chatter:=/news", "-o", "news", cwd=folder)
    assert Bag(folder / "news").contents.counts == {"/map": 1, "/news": 20}
    machine.look("bag", "convert", "bag", "--compression", "lz4", "-b", "100", "-o", "small", cwd=folder)
    assert len(Bag(folder / "small").files) > 1
    machine.look("bag", "convert", "bag", "-s", "sqlite3", "-o", "old", cwd=folder)
    assert Bag(folder / "old").storage == "sqlite3"
    machine.look("bag", "merge", "news", "bag_filtered", "-o", "both", cwd=folder)
    assert Bag(folder / "both").contents.message_count == 31

    text = machine.look("bag", "filter", "bag", "--topics", "/map", "--topics", "/mapp", "-o", "map", cwd=folder)
    assert text.startswith("note: bag: no topic /mapp; did you mean '/map'?\nmap: 1 messages of 1 topic, ")

    file = folder / "bag" / "bag_0.mcap"
    file.write_bytes(file.read_bytes()[:-300])
    assert "graphflow bag recover mends it" in machine.look("bag", "info", "bag", cwd=folder)
    machine.look("bag", "recover", "bag", cwd=folder)
    assert list(Bag(folder / "bag_recovered").records()) == sorted(some_records(), key=lambda r: r.log_ns)


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        ("info nothing", 1, "error: nothing: there is no such file or folder"),
        ("play nothing", 1, "error: nothing: there is no such file or folder"),
        ("play bag --rate 0", 2, "--rate"),
        ("play bag -r /a:=/b", 2, "'/a:=/b' is a remap rule: write -m /a:=/b"),
        ("play bag -m /a:/b", 2, "'/a:/b' is not a remap rule; write OLD:=NEW"),
        ("play bag -s 2", 2, "-s is the bag's format, mcap or sqlite3, not '2'; -r is the speed"),
        ("record -a /chatter", 2, "-a records all topics: leave it out, or the names /chatter"),
        ("play bag --clock often", 2, "--clock takes a rate in Hz"),
        ("record -o /chatter", 2, "no topics to record; /chatter, after -o, is the bag's folder; name topics"),
        ("record", 2, "no topics to record; name topics, or record all: graphflow bag record -a"),
        ("record -e [", 2, "'[' is not a regular expression"),
        ("record -a -o bag", 1, "bag exists already; choose another name with -o"),
        ("filter bag -o bag", 1, "bag exists already; choose another name with -o"),
        ("record a//b", 2, "a//b"),
        ("filter bag -m /a:/b -o new", 2, "'/a:/b' is not a remap rule; write OLD:=NEW"),
        (
            "filter bag --start 2023-11-14T22:13:20+00:00",
            2,
            "'2023-11-14T22:13:20+00:00' is not a number of seconds, from",
        ),
        (
            "filter bag --end soon",
            2,
            "'soon' is not a number of seconds, from the beginning of the bag or since 1970\n",
        ),
        ("play bag -m /map /b", 2, "a remap rule is one word: graphflow bag play bag -m /map:=/b"),
        ("play bag /map:=/b", 2, "a remap rule is one word: graphflow bag play bag -m /map:=/b"),
        ("play bag --loop 3", 2, "--loop takes no value; leave out 3"),
        ("record -a walk", 2, "-o names the bag's folder: graphflow bag record -a -o walk"),
        ("record -O walk", 2, "No such option '-O'. Did you mean '-o'?"),
        ("info bga", 1, "there is no such file or folder; did you mean 'bag'?"),
        ("play bag /map", 2, "name topics with --topics: graphflow bag play bag --topics /map"),
        ("filter /map /count bag", 2, "name topics with --topics: graphflow bag filter bag --topics '/map /count'"),
        ("echo /map bag", 2, "the bag comes first: graphflow bag echo bag /map"),
        ("plot /count.data bag", 2, "the bag comes first: graphflow bag plot bag /count.data"),
        (
            "filter bag --exclude-topic-types std_msgs/String -e chatter -o new",
            1,
            "error: bag: no topic matches; there",
        ),
        ("echo bag --csv -n 0", 2, "0 is not in the range"),
        ("echo bag /chater", 1, "error: bag: no topic /chater; did you mean '/chatter'?"),
        ("filter bag --topics /topp -o new", 1, "error: bag: no topic /topp; there is /chatter, /count, /map"),
        ("filter bag -e nothing -o new", 1, "error: bag: no topic matches; there is /chatter, /count, /map"),
        ("filter bag --start 9 -o new", 1, "no message of /chatter, /count, /map from 9 s on; it lasts 1.95 s"),
        ("ply bag", 2, "did you mean 'play'?"),
    ],
)
def test_words_that_do_not_fit(machine: Machine, folder: Path, words: str, code: int, told: str) -> None:
    """Say what to write instead; nothing is written."""
    assert told in machine.look("bag", *words.split(), cwd=folder, code=code)
    assert [file.name for file in folder.iterdir() if (file / "metadata.yaml").exists()] == ["bag"]
    assert [file.name for file in folder.iterdir() if file.name not in ("state", "run")] == ["bag"]


def test_convert_by_a_file_of_options(machine: Machine, folder: Path) -> None:
    """`-o` is a file of options, as in ROS 2, if it exists; otherwise it is the new bag's folder."""
    rows = "[{uri: some, storage_id: mcap, topics: [/count, /mapp]}, {uri: all, storage_id: sqlite3, alll: true}]"
    (folder / "out.yaml").write_text(f"output_bags: {rows}\n")
    text = machine.look("bag", "convert", "-i", "bag", "mcap", "-o", "out.yaml", cwd=folder)
    assert "note: bag: no topic /mapp; did you mean '/map'?\nsome: 20 messages of 1 topic, " in text
    assert "note: out.yaml: alll has no effect; did you mean 'all'?\nall: 41 messages of 3 topics, " in text
    assert [file.suffix for file in (folder / "all").iterdir() if file.suffix != ".yaml"] == [".db3"]
    machine.look("bag", "convert", "-i", "some", "-i", "all", "-o", "both", cwd=folder)
    assert Bag(folder / "both").contents.message_count == 61
    assert "other.yaml: No such file or directory; to make a bag of that name" in machine.look(
        "bag", "convert", "bag", "-o", "other.yaml", cwd=folder, code=2
    )
    assert "name one bag, or several with -i" in machine.look("bag", "convert", "bag", "all", cwd=folder, code=2)
