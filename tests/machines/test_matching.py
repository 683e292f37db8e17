"""Who reaches whom, and what is said about those who do not."""

from __future__ import annotations

import pytest

from graphflow.machines.matching import Verdict, shared, verdict
from graphflow.qos import Durability, Qos, Reliability
from graphflow.wire.liveliness import Entity, Kind

TYPE, HASH = "std_msgs/msg/String", "RIHS01_df668c740482bbd4"


def endpoint(
    kind: Kind, node: str = "there", *, name: str = "/t", type_: str = TYPE, hash_: str = HASH, **qos: object
) -> Entity:
    """An endpoint of a node."""
    return Entity(0, "a1", 0, 1, kind, "/", node, name, type_, hash_, Qos(**qos))  # type: ignore[arg-type]


HERE = endpoint(Kind.SUBSCRIPTION, "here")


@pytest.mark.parametrize(
    "other",
    [
        endpoint(Kind.SUBSCRIPTION),
        endpoint(Kind.SERVICE),
        endpoint(Kind.PUBLISHER, name="/other"),
        Entity(0, "a1", 0, 0, Kind.NODE, "/", "t"),
    ],
)
def test_only_counterparts_of_the_name_count(other: Entity) -> None:
    """A subscription has to do with publishers of its topic and with nothing else."""
    assert verdict(HERE, other) is None


@pytest.mark.parametrize(
    ("own", "other"),
    [(Kind.SUBSCRIPTION, Kind.PUBLISHER), (Kind.PUBLISHER, Kind.SUBSCRIPTION), (Kind.CLIENT, Kind.SERVICE)],
)
def test_equal_keys_reach_each_other(own: Kind, other: Kind) -> None:
    """The same name, type and definition is all that delivery needs."""
    assert verdict(endpoint(own), endpoint(other)) == Verdict(True)


def test_another_type_is_reported_from_both_sides() -> None:
    """Two types on one topic: nothing passes, and each side says who has what."""
    there = endpoint(Kind.PUBLISHER, type_="std_msgs/msg/Int32", hash_="RIHS01_b6578ded")
    for own, other in ((HERE, there), (there, HERE)):
        judged = verdict(own, other)
        assert judged is not None
        assert not judged.reaches
        assert other.node_name in judged.complaint
        assert "std_msgs/msg/Int32" in judged.complaint
        assert "std_msgs/msg/String" in judged.complaint


def test_another_definition_is_reported() -> None:
    """The same type name with another hash: nothing passes, and the two hashes are shown."""
    judged = verdict(HERE, endpoint(Kind.PUBLISHER, hash_="RIHS01_00112233445566"))
    assert judged == Verdict(
        False,
        complaint="/t: nothing passes between the publisher of /there and the subscription here: they have different "
        "definitions of std_msgs/msg/String (RIHS01_00112233 there, RIHS01_df668c74 here): use the same definition "
        "file on both sides, and start the older one again",
    )


def test_a_peer_of_another_distribution_is_named() -> None:
    """When the reason is a wire profile, the remedy is to choose another."""
    own = endpoint(Kind.SUBSCRIPTION, type_="turtlesim/msg/Pose")
    judged = verdict(own, endpoint(Kind.PUBLISHER, type_="turtlesim_msgs/msg/Pose"), "jazzy")
    assert judged is not None
    assert "start with --wire kilted" in judged.complaint


def test_policies_that_dds_refuses_are_named_and_messages_pass() -> None:
    """An offer below what is asked for is reported with its policies; over Zenoh it is no obstacle."""
    offer = endpoint(Kind.PUBLISHER, reliability=Reliability.BEST_EFFORT)
    wish = endpoint(Kind.SUBSCRIPTION, "here", durability=Durability.TRANSIENT_LOCAL)
    for own, other in ((wish, offer), (offer, wish)):
        judged = verdict(own, other)
        assert judged is not None
        assert judged.reaches
        assert judged.policies == ("reliability", "durability")
        assert judged.complaint == (
            "/t: the publisher of /there offers less than the subscription of /here asks for: reliability, "
            "durability. Over Zenoh messages pass, but not those published before the subscription opened; over DDS "
            "none would: have the publisher offer durability TRANSIENT_LOCAL, and the subscription ask for "
            "reliability BEST_EFFORT"
        )


def test_who_asks_for_kept_messages_is_told_how_to_receive_them() -> None:
    """The remedy for durability is a publisher that keeps messages; for another policy alone, a weaker request."""
    wish = endpoint(Kind.SUBSCRIPTION, "here", durability=Durability.TRANSIENT_LOCAL)
    judged = verdict(wish, endpoint(Kind.PUBLISHER))
    assert judged is not None
    assert judged.complaint.endswith("none would: have the publisher offer durability TRANSIENT_LOCAL")
    judged = verdict(endpoint(Kind.SUBSCRIPTION), endpoint(Kind.PUBLISHER, reliability=Reliability.BEST_EFFORT))
    assert judged is not None
    assert judged.complaint.endswith("have the subscription ask for reliability BEST_EFFORT")
    judged = verdict(wish, endpoint(Kind.PUBLISHER, durability=Durability.TRANSIENT_LOCAL))
    assert judged is not None
    assert not judged.complaint


def test_services_of_several_nodes() -> None:
    """Are told together where the nodes are the same; nodes of one name, and hidden services, are another matter."""
    names = ("/go/_action/send_goal", "/go/_action/get_result", "/_hidden")
    servers = [endpoint(Kind.SERVICE, node, name=name) for node in "abcc" for name in names]
    told = "offered by /a, /b and /c: each call reaches all of them;"
    assert shared(servers) == [
        f"/go is {told} remap one: --ros-args -r go:=NAME, or -r __ns:=/NAMESPACE",
    ]
    servers += [endpoint(Kind.SERVICE, node, name=f"/s{number}") for node in "abc" for number in range(5)]
    assert shared(servers) == [f"/go, /s0, /s1, /s2 and 2 more are {told} move one: --ros-args -r __ns:=/NAMESPACE"]
    assert shared(endpoint(Kind.SERVICE, "c", name="/s") for _ in range(2)) == []
    assert shared(endpoint(Kind.CLIENT, node, name="/s") for node in "ab") == []
