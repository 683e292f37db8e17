"""Bags of ROS 1, as `rosbags` writes them: their types become ROS 2's, and what is no bag is told."""

from __future__ import annotations

import contextlib
import sys
from pathlib import Path
from typing import Any, Self

import numpy as np
import pytest
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from graphflow.bag.formats import ros1_file
from graphflow.bag.reader import Bag
from graphflow.bag.typed import read
from graphflow.bag.writer import BagWriter
from graphflow.errors import BagError
from graphflow.msgs import registry
from graphflow.qos import Durability
from tests.bag.cast import START
from tests.cases import slow

RULE = "=" * 80 + "\nMSG: "
HEADER = f"{RULE}std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
LAB = f"""\
Header header
uint8 LIMIT=3
string WORD=a "b"
int32 no_Constant
time whenSeen
duration[] spans
char c
byte b
ros1_lab_msgs/part[2] parts
{HEADER}{RULE}ros1_lab_msgs/part
float64 X
int8[] k
"""
"""Of a type that is nowhere installed, with names that ROS 2 does not allow."""

TRANSFORM = (
    f"{RULE}geometry_msgs/TransformStamped\nHeader header\nstring child_frame_id\nTransform transform\n"
    f"{RULE}geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n"
    f"{RULE}geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
    f"{RULE}geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
)


class Store:
    """Types of ROS 1, and messages made of them."""

    def __init__(self) -> None:
        self.types = get_typestore(Stores.ROS1_NOETIC)

    @classmethod
    def of(cls, name: str, text: str) -> Self:
        """Only a type and those in it."""
        store = cls()
        store.types = get_typestore(Stores.EMPTY)
        store.types.register(get_types_from_msg(text, name))
        return store

    def __call__(self, type_: str, *values: Any) -> Any:
        return self.types.types[type_](*values)

    def header(self) -> Any:
        return self("std_msgs/msg/Header", 7, self("builtin_interfaces/msg/Time", 5, 6), "map")


def old(path: Path, store: Store, *messages: tuple[str, str, Any], form: str = "", **more: Any) -> Path:
    """A bag of messages, each a topic, a type and a message, a second apart."""
    writer = Writer(path)
    if form:
        writer.set_compression(Writer.CompressionFormat[form])
    with writer:
        made: dict[str, Any] = {}
        for number, (topic, type_, message) in enumerate(messages):
            if topic not in made:
                made[topic] = writer.add_connection(topic, type_, typestore=store.types, **more)
            data = store.types.serialize_ros1(message, type_)
            writer.write(made[topic], START + number * 10**9, data)
    return path


def chatter(path: Path, form: str = "", count: int = 3) -> Path:
    store = Store()
    said = [("/chatter", "std_msgs/msg/String", store("std_msgs/msg/String", f"hello {n}")) for n in range(count)]
    return old(path, store, *said, form=form)


@pytest.mark.parametrize("form", ["", "BZ2", "LZ4"])
def test_what_is_in_one(tmp_path: Path, form: str) -> None:
    """Topics with ROS 2's types and hashes; messages of a time."""
    bag = Bag(chatter(tmp_path / "a.bag", form))
    assert (bag.storage, bag.contents.counts) == ("rosbag_v2", {"/chatter": 3})
    assert (bag.contents.start_ns, bag.contents.end_ns) == (START, START + 2 * 10**9)
    assert bag.contents.topics["/chatter"].hash == registry.hash_of("std_msgs/msg/String")
    assert [s.message.data for s in read(bag.path, ["/chatter"])] == ["hello 0", "hello 1", "hello 2"]
    assert [s.message.data for s in read(bag.path, start_ns=START + 1, end_ns=START + 2 * 10**9)] == ["hello 1"]
    assert list(bag.records(["/other"])) == []


def test_types_that_are_known_here(tmp_path: Path) -> None:
    """Their fields have ROS 2's names, wherever ROS 1 had others or more; nothing of them is printed."""
    store = Store()
    roi = store("sensor_msgs/msg/RegionOfInterest", 1, 2, 3, 4, True)
    numbers = [np.arange(n, dtype=float) for n in (5, 9, 9, 12)]
    info = store("sensor_msgs/msg/CameraInfo", store.header(), 480, 640, "plumb_bob", *numbers, 1, 2, roi)
    empty = store("std_msgs/msg/Empty")
    path = old(
        tmp_path / "a.bag", store, ("/cam", "sensor_msgs/msg/CameraInfo", info), ("/go", "std_msgs/msg/Empty", empty)
    )
    camera, go = (said.message for said in read(path))
    assert (camera.header.stamp.sec, camera.header.frame_id, camera.width) == (5, "map", 640)
    assert (list(camera.d), camera.k[8], camera.p[11], camera.roi.do_rectify) == ([0, 1, 2, 3, 4], 8, 11, True)
    assert go == registry.interface_class("std_msgs/msg/Empty")()


def test_a_type_that_has_changed(tmp_path: Path) -> None:
    """Fields of the same names are kept, the others are as by default."""
    store = Store.of("geometry_msgs/msg/Vector3", "float64 z\nfloat64 x\n")
    vector = store("geometry_msgs/msg/Vector3", 3.0, 1.0)
    [said] = read(old(tmp_path / "a.bag", store, ("/v", "geometry_msgs/msg/Vector3", vector)))
    assert (said.message.x, said.message.y, said.message.z) == (1.0, 0.0, 3.0)


@slow
def test_types_that_are_not_known_here(tmp_path: Path) -> None:
    """As the bag defines them; a bag that is made of it can be read by itself."""
    store = Store.of("ros1_lab_msgs/msg/Thing", LAB)
    time, span = store("builtin_interfaces/msg/Time", 1, 2), store("builtin_interfaces/msg/Duration", 3, 4)
    parts = [store("ros1_lab_msgs/msg/part", x, np.array([1, -2], np.int8)) for x in (1.5, 2.5)]
    thing = store("ros1_lab_msgs/msg/Thing", store.header(), -9, time, [span], 200, 5, parts)
    bag = Bag(old(tmp_path / "a.bag", store, ("things", "ros1_lab_msgs/msg/Thing", thing)))
    with BagWriter(tmp_path / "new") as writer:
        for record in bag.records():
            writer.add(record)
    for path in (bag.path, tmp_path / "new"):
        [said] = read(path, ["/things"])
        found = said.message
        assert (found.header.frame_id, found.no_constant, found.when_seen.nanosec, found.c) == ("map", -9, 2, 200)
        assert (found.spans[0].sec, [p.x for p in found.parts], list(found.parts[1].k)) == (3, [1.5, 2.5], [1, -2])
        assert (type(found).LIMIT, type(found).WORD) == (3, 'a "b"')


def test_transforms(tmp_path: Path) -> None:
    """The first message of transforms was called otherwise."""
    store = Store.of("tf/msg/tfMessage", f"geometry_msgs/TransformStamped[] transforms\n{TRANSFORM}{HEADER}")
    vector, turn = store("geometry_msgs/msg/Vector3", 1.0, 2.0, 3.0), store("geometry_msgs/msg/Quaternion", 0, 0, 0, 1)
    transform = store("geometry_msgs/msg/Transform", vector, turn)
    stamped = store("geometry_msgs/msg/TransformStamped", store.header(), "base", transform)
    said = ("/tf", "tf/msg/tfMessage", store("tf/msg/tfMessage", [stamped]))
    bag = Bag(old(tmp_path / "a.bag", store, said))
    assert bag.contents.topics["/tf"].type == "tf2_msgs/msg/TFMessage"
    [found] = read(bag.path)
    assert found.message.transforms[0].transform.translation.z == 3.0


def test_latched_topics(tmp_path: Path) -> None:
    """Are kept for late subscriptions, as ROS 2 calls it."""
    store = Store()
    said = ("/map", "std_msgs/msg/String", store("std_msgs/msg/String", "map"))
    for latching in (0, 1):
        [qos] = Bag(old(tmp_path / f"{latching}.bag", store, said, latching=latching)).contents.topics["/map"].qos
        assert (qos.durability is Durability.TRANSIENT_LOCAL) == bool(latching)


def test_without_rosbags(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The extra is named."""
    path = chatter(tmp_path / "a.bag")
    monkeypatch.setitem(sys.modules, "rosbags.rosbag1", None)
    with pytest.raises(BagError, match=r"a\.bag: ROS 1 bags need the extra `ros1`: pip install "):
        Bag(path)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "a.bag: .*empty"),
        (b"hello", "a.bag: File magic is invalid"),
        (b"#ROSBAG V1.2\n", "a.bag: Bag version 102 is not supported"),
        (b"#ROSBAG V2.0\n", "a.bag: "),
        (b"#ROSBAG V2.0\n\xff\xff\xff\xff", "a.bag: "),
    ],
)
def test_what_is_no_bag(tmp_path: Path, data: bytes, message: str) -> None:
    """Says what it is instead."""
    path = tmp_path / "a.bag"
    path.write_bytes(data)
    with pytest.raises(BagError, match=message):
        Bag(path)


@pytest.mark.parametrize(
    "name", ["2td_msgs/msg/String", "a/msg/S:\n  import sys\n  sys.executed = 1\nclass S", "a/msg/B C"]
)
def test_names_that_are_none(tmp_path: Path, name: str) -> None:
    """Nothing that a bag says is executed."""
    path = tmp_path / "a.bag"
    with Writer(path) as writer:
        connection = writer.add_connection("/x", name, msgdef="string data\n", md5sum="0")
        writer.write(connection, START, bytes(4))
    with pytest.raises(BagError, match=r"the definition of .* cannot be used: "):
        Bag(path)
    assert not hasattr(sys, "executed")


@slow
@pytest.mark.parametrize("form", ["", "BZ2", "LZ4"])
def test_damaged_ones(tmp_path: Path, form: str) -> None:
    """Whatever byte is another, it is a bag or an error of a bag."""
    path = chatter(tmp_path / "a.bag", form)
    data = path.read_bytes()
    for at in range(0, len(data), len(data) // 40):
        path.write_bytes(data[:at] + bytes([data[at] ^ 0x41]) + data[at + 1 :])
        with contextlib.suppress(BagError):
            list(Bag(path).records())


@pytest.mark.parametrize("form", ["BZ2", "LZ4"])
def test_bombs(tmp_path: Path, form: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A chunk of more than the bound is refused."""
    path = chatter(tmp_path / "a.bag", form, count=100)
    monkeypatch.setattr(ros1_file, "CHUNK_BOUND", 1000)
    with pytest.raises(BagError, match="a chunk has more than 1,000 bytes"):
        list(Bag(path).records())


def test_a_folder_of_them(tmp_path: Path) -> None:
    """Is one bag, whatever their names; files of ROS 2 in it come first."""
    store = Store()
    text = store("std_msgs/msg/String", "later")
    writer = Writer(tmp_path / "a_1.bag")
    with writer:
        made = writer.add_connection("/chatter", "std_msgs/msg/String", typestore=store.types)
        writer.write(made, START + 10 * 10**9, store.types.serialize_ros1(text, "std_msgs/msg/String"))
    chatter(tmp_path / "b_2.bag", count=2)
    bag = Bag(tmp_path)
    assert (bag.storage, bag.contents.counts) == ("rosbag_v2", {"/chatter": 3})
    assert [s.message.data for s in read(tmp_path)] == ["hello 0", "hello 1", "later"]
    with BagWriter(tmp_path / "new") as new:
        for record in bag.records():
            new.add(record)
    for file in (tmp_path / "new").glob("*.mcap"):
        file.rename(tmp_path / file.name)
    assert Bag(tmp_path).storage == "mcap"


@pytest.mark.parametrize("name", ["cut.bag", "cut.bag.active"])
@pytest.mark.parametrize("has_place", [True, False])
def test_a_recording_that_did_not_end(tmp_path: Path, name: str, has_place: bool) -> None:
    """Has no index; what writes one is told."""
    data = chatter(tmp_path / "a.bag").read_bytes()
    at = data.index(b"index_pos=") + len(b"index_pos=")
    place = int.from_bytes(data[at : at + 8], "little")
    (tmp_path / name).write_bytes((data if has_place else data[:at] + bytes(8) + data[at + 8 :])[: place + 3])
    with pytest.raises(BagError, match=rf"{name}: it has no whole index, .* rosbag reindex {name}$"):
        Bag(tmp_path / name)
