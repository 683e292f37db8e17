"""Liveliness tokens, the GIDs they imply, and QoS chunks."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from graphflow import qos as profiles
from graphflow.qos import DEFAULT_DEPTH, INFINITE_NS, Durability, History, Liveliness, Qos, Reliability
from graphflow.wire.gid import gid
from graphflow.wire.liveliness import TOKEN_BOUND, Entity, Kind, parse_qos, parse_token, qos_chunk, watch_key

STRING = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
ADD = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
JOINTS = "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"
ADD_TYPE = "example_interfaces/srv/AddTwoInts"

# The first five tokens stand in rmw_zenoh's design document; the GIDs were computed by upstream's hash code.
EXAMPLES = [
    (
        Entity(0, "aac3178e146ba6f1fc6e6a4085e77f21", 0, 0, Kind.NODE, "/", "listener"),
        "@ros2_lv/0/aac3178e146ba6f1fc6e6a4085e77f21/0/0/NN/%/%/listener",
        "5bd72f4daf53c0bb00c7394e7fc19547",
    ),
    (
        Entity(
            0,
            "aac3178e146ba6f1fc6e6a4085e77f21",
            0,
            10,
            Kind.SUBSCRIPTION,
            "/",
            "listener",
            "/chatter",
            "std_msgs/msg/String",
            STRING,
            Qos(),
        ),
        "@ros2_lv/0/aac3178e146ba6f1fc6e6a4085e77f21/0/10/MS/%/%/listener/%chatter/"
        f"std_msgs::msg::dds_::String_/{STRING}/::,10:,:,:,,",
        "f15f21d2fafc22891bb0db868309bfcb",
    ),
    (
        Entity(
            0,
            "8b20917502ee955ac4476e0266340d5c",
            0,
            10,
            Kind.PUBLISHER,
            "/",
            "talker",
            "/chatter",
            "std_msgs/msg/String",
            STRING,
            Qos(depth=7),
        ),
        "@ros2_lv/0/8b20917502ee955ac4476e0266340d5c/0/10/MP/%/%/talker/%chatter/"
        f"std_msgs::msg::dds_::String_/{STRING}/::,7:,:,:,,",
        "eb85fa883b7846dc448a4501890ad062",
    ),
    (
        Entity(
            0,
            "f9980ee0495eaafb3e38f0d19e2eae12",
            0,
            10,
            Kind.SERVICE,
            "/",
            "add_two_ints_server",
            "/add_two_ints",
            ADD_TYPE,
            ADD,
            Qos(),
        ),
        "@ros2_lv/0/f9980ee0495eaafb3e38f0d19e2eae12/0/10/SS/%/%/add_two_ints_server/%add_two_ints/"
        f"example_interfaces::srv::dds_::AddTwoInts_/{ADD}/::,10:,:,:,,",
        "d47771a4e2405c092088d4552a3b7b13",
    ),
    (
        Entity(
            0,
            "e1dc8d1b45ae8717fce78689cc655685",
            0,
            10,
            Kind.CLIENT,
            "/",
            "add_two_ints_client",
            "/add_two_ints",
            ADD_TYPE,
            ADD,
            Qos(),
        ),
        "@ros2_lv/0/e1dc8d1b45ae8717fce78689cc655685/0/10/SC/%/%/add_two_ints_client/%add_two_ints/"
        f"example_interfaces::srv::dds_::AddTwoInts_/{ADD}/::,10:,:,:,,",
        "26970b3b2b7cf4e3c6219b0549875e8c",
    ),
    (
        Entity(
            42,
            "1",
            3,
            7,
            Kind.PUBLISHER,
            "/robot1/arm",
            "ctl",
            "/robot1/arm/state",
            "sensor_msgs/msg/JointState",
            JOINTS,
            profiles.SENSOR_DATA,
        ),
        "@ros2_lv/42/1/3/7/MP/%/%robot1%arm/ctl/%robot1%arm%state/"
        f"sensor_msgs::msg::dds_::JointState_/{JOINTS}/2::,5:,:,:,,",
        "efefa5f3c117d304ca1ea04092892771",
    ),
]
LISTENER = EXAMPLES[1][1]

CHUNKS = [
    (Qos(depth=42), "::,:,:,:,,"),
    (profiles.DEFAULT, "::,10:,:,:,,"),
    (profiles.SERVICES, "::,10:,:,:,,"),
    (profiles.SENSOR_DATA, "2::,5:,:,:,,"),
    (profiles.PARAMETERS, "::,1000:,:,:,,"),
    (Qos(depth=1, durability=Durability.TRANSIENT_LOCAL), ":1:,1:,:,:,,"),
    (profiles.ROSOUT, ":1:,1000:,:10,0:,,"),
    (Qos(depth=1, reliability=Reliability.BEST_EFFORT), "2::,1:,:,:,,"),
    (Qos(depth=42, history=History.KEEP_ALL), "::2,:,:,:,,"),
    (Qos(depth=7, history=History.KEEP_ALL), "::2,7:,:,:,,"),
    (Qos(deadline_ns=1_500_000_000), "::,10:1,500000000:,:,,"),
    (Qos(liveliness=Liveliness.MANUAL_BY_TOPIC, lease_ns=2_000_000_000), "::,10:,:,:3,2,0"),
    (Qos(lifespan_ns=9_223_372_036_000_000_000), "::,10:,:,0:,,"),
    (Qos(lifespan_ns=1_854_775_807), "::,10:,:1,:,,"),
]


@pytest.mark.parametrize(("entity", "token", "gid_hex"), EXAMPLES)
def test_token_and_gid_are_upstreams(entity: Entity, token: str, gid_hex: str) -> None:
    """An entity announces itself by the token upstream writes, and has the GID upstream hashes from it."""
    assert (entity.token, entity.gid.hex()) == (token, gid_hex)


@pytest.mark.parametrize(("entity", "token", "gid_hex"), EXAMPLES)
def test_token_is_read(entity: Entity, token: str, gid_hex: str) -> None:
    """A token gives back the entity and its GID."""
    parsed = parse_token(token)
    assert parsed == entity
    assert parsed.gid.hex() == gid_hex


def test_parsed_entity_keeps_its_token() -> None:
    """A token with chunks or values we would not write keeps its text, since its owner hashed that."""
    token = LISTENER.replace("/::,10:", "/1:2:1,10:") + "/cpu"
    parsed = parse_token(token)
    assert parsed == EXAMPLES[1][0]
    assert (parsed.token, parsed.gid) == (token, gid(token))


def test_changed_copy_of_a_parsed_entity_has_its_own_token() -> None:
    """An entity made from a parsed one announces what it is itself."""
    parsed = parse_token(LISTENER)
    assert parsed is not None
    assert parsed._replace(eid=11).token == LISTENER.replace("/0/10/", "/0/11/")


def test_enclave_is_carried() -> None:
    """A security enclave comes back as it was, for nodes and endpoints."""
    for entity in (EXAMPLES[0][0], EXAMPLES[1][0]):
        changed = entity._replace(enclave="/a/b")
        assert "/%a%b/" in changed.token
        assert parse_token(changed.token) == changed


@pytest.mark.parametrize(
    "token",
    [
        "",
        "@ros2_lv",
        "@ros2_lv/0/abc/0/0/NN/%/%",
        "@ros2_lv/0/abc/0/0/NN/%//n",
        "@ros2_lv/0/abc/0/0/NN/%/%/n/",
        "@ros2_lv/0/abc/0/0/XX/%/%/n",
        "@ros2_lv/x/abc/0/0/NN/%/%/n",
        "@ros2_lv/0/abc/-1/0/NN/%/%/n",
        "@ros2_lv/0/abc/0/y/NN/%/%/n",
        "@/0/@ros2_lv/abc/0/0/NN/%/%/n",
        "ros2_lv/0/abc/0/0/NN/%/%/n",
        LISTENER.rpartition("/")[0],
    ],
)
def test_other_tokens_are_none(token: str) -> None:
    """Too few or empty chunks, an unknown kind, ids that are no numbers, another first chunk: no entity."""
    assert parse_token(token) is None


def test_token_of_an_unknown_type_spelling_is_read() -> None:
    """A type in no known spelling is shown as it is, and the entity still has its GID."""
    token = LISTENER.replace("std_msgs::msg::dds_::String_", "odd")
    parsed = parse_token(token)
    assert parsed is not None
    assert (parsed.type, parsed.gid) == ("odd", gid(token))


def test_node_name_joins_namespace() -> None:
    """A node's full name has its namespace in front."""
    assert [e.node_name for e, _, _ in EXAMPLES[:1] + EXAMPLES[5:]] == ["/listener", "/robot1/arm/ctl"]


def test_data_key_is_that_of_the_endpoint() -> None:
    """An endpoint's data key has its domain, name, type and hash."""
    assert EXAMPLES[5][0].data_key == f"42/robot1/arm/state/sensor_msgs::msg::dds_::JointState_/{JOINTS}"


def test_watch_key_is_of_one_domain() -> None:
    """The key to watch names the domain, so that others are not seen."""
    assert watch_key(7) == "@ros2_lv/7/**"


@pytest.mark.parametrize(("profile", "chunk"), CHUNKS)
def test_qos_chunk_is_written(profile: Qos, chunk: str) -> None:
    """Values that equal rmw_zenoh's defaults are empty, seconds and nanoseconds each for themselves."""
    assert qos_chunk(profile) == chunk


@pytest.mark.parametrize(("profile", "chunk"), CHUNKS)
def test_qos_chunk_is_read(profile: Qos, chunk: str) -> None:
    """A chunk gives back the profile it was written from."""
    assert parse_qos(chunk) == profile


@pytest.mark.parametrize(
    "chunk", ["", ":", "x:y:z,w:a,b:c,d:e,f,g", "0:0:0,:,:,:0,,", "3:3:3,:,:,:4,,", "4:4:4,:,:,:5,,"]
)
def test_unknown_qos_values_become_defaults(chunk: str) -> None:
    """Missing, foreign and newer values are read as the default, never refused."""
    assert parse_qos(chunk) == Qos(depth=42)


_NS = st.integers(0, INFINITE_NS)


@settings(derandomize=True, deadline=None)
@given(
    st.builds(
        Qos,
        depth=st.integers(1, 2**40),
        reliability=st.sampled_from([Reliability.RELIABLE, Reliability.BEST_EFFORT]),
        durability=st.sampled_from([Durability.TRANSIENT_LOCAL, Durability.VOLATILE]),
        history=st.sampled_from(History),
        deadline_ns=_NS,
        lifespan_ns=_NS,
        liveliness=st.sampled_from(Liveliness),
        lease_ns=_NS,
    )
)
def test_every_profile_survives(profile: Qos) -> None:
    """Any profile at all comes back from its chunk."""
    assert parse_qos(qos_chunk(profile)) == profile


@settings(derandomize=True, deadline=None)
@given(
    st.text(max_size=60), st.lists(st.sampled_from(["", "0", "7", "MP", "NN", "%", "%a", "x", "::", "é"]), max_size=15)
)
def test_no_token_raises(text: str, chunks: list[str]) -> None:
    """Whatever stands where a token should be is an entity or None."""
    for token in (text, f"@ros2_lv/{text}", "/".join(["@ros2_lv", *chunks])):
        parsed = parse_token(token)
        assert parsed is None or parsed.token == token


LONG = "9" * 5000


@pytest.mark.parametrize(
    "change",
    [
        ("/0/", f"/{LONG}/"),
        ("/0/", "/٣/"),
        ("/0/", f"/{2**64}/"),
        ("/listener/", "/liste\x1b[2Jner/"),
        ("/listener/", f"/{'x' * TOKEN_BOUND}/"),
    ],
)
def test_tokens_of_strangers(change: tuple[str, str]) -> None:
    """Numbers that are too long are never converted; no name clears a screen; nothing is endless."""
    assert parse_token(LISTENER) is not None
    hostile = LISTENER.replace(*change)
    assert hostile != LISTENER
    assert parse_token(hostile) is None


def test_profiles_of_strangers() -> None:
    """Numbers that are too long count as missing; spans end at infinity."""
    qos = parse_qos(f"{LONG}:{LONG}:{LONG},{LONG}:{LONG},{LONG}:{2**63},5:2,{LONG},1")
    assert (qos.depth, qos.deadline_ns, qos.lifespan_ns) == (DEFAULT_DEPTH, INFINITE_NS, INFINITE_NS)
    assert qos.lease_ns <= INFINITE_NS
