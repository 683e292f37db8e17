"""Topics with nobody at the other end, and those that were probably meant."""

from __future__ import annotations

import pytest

from graphflow.machines.near_topics import COMPARED, by_type, did_you_mean_topic, is_misspelt, is_near
from graphflow.names import MAX_LENGTH
from graphflow.wire.liveliness import Entity, Kind

TWIST = "geometry_msgs/msg/Twist"


def endpoint(kind: Kind, node: str, name: str, type_: str = TWIST) -> Entity:
    return Entity(0, node, 1, hash((kind, name)) % 1000, kind, "/", node, name, type_)


@pytest.mark.parametrize(
    ("name", "other", "near"),
    [
        ("/turtle1/cmd_vl", "/turtle1/cmd_vel", True),
        ("/turtle1/cmdvel", "/turtle1/cmd_vel", True),
        ("/turtle1/CMD_VEL", "/turtle1/cmd_vel", True),
        ("/turtle/pose", "/turtl/pose", True),
        ("/cmd_vel", "/turtle1/cmd_vel", True),
        ("/turtle1/cmd_vel", "/cmd_vel", True),
        ("/turtle/cmd_vel", "/turtle1/cmd_vel", True),
        ("/vel", "/cmd_vel", False),
        ("/turtle2/cmd_vel", "/turtle1/cmd_vel", False),
        ("/cmd_vel_nav", "/cmd_vel", False),
        ("/left/image", "/right/image", False),
        ("/goal_a", "/goal_b", False),
        ("/a/scan", "/b/scan", False),
    ],
)
def test_near_names(name: str, other: str, near: bool) -> None:
    """Are those that one may write for the other; names that differ on purpose are not."""
    assert is_near(name, other) is near
    assert is_near(other, name) is near


def test_other_case_is_misspelt() -> None:
    """As far as it is a few letters, as anywhere; a missing namespace is not."""
    assert is_misspelt("/turtle1/Pose", "/turtle1/pose")
    assert not is_misspelt("/pose", "/turtle1/pose")


def test_what_was_meant() -> None:
    """Is the nearest topic of the same type that has the other end, with who is there."""
    own = endpoint(Kind.PUBLISHER, "circle", "/cmd_vel")
    there = by_type(
        [
            own,
            endpoint(Kind.SUBSCRIPTION, "turtlesim", "/turtle1/cmd_vel"),
            endpoint(Kind.SUBSCRIPTION, "other", "/a/much/longer/cmd_vel"),
            endpoint(Kind.SUBSCRIPTION, "log", "/cmd_vl", "std_msgs/msg/String"),
            endpoint(Kind.PUBLISHER, "mux", "/cmd_ve"),
            endpoint(Kind.SUBSCRIPTION, "_graphflow_7", "/cmd_vell"),
        ],
        {TWIST, "std_msgs/msg/String"},
    )
    assert did_you_mean_topic(own, there) == (
        f"nobody listens to /cmd_vel [{TWIST}]; did you mean '/turtle1/cmd_vel', to which /turtlesim listens?"
    )


def test_a_slash_that_keeps_the_namespace_out() -> None:
    """The name without it is the one that was meant."""
    own = endpoint(Kind.SUBSCRIPTION, "follower", "/pose")._replace(namespace="/turtle1")
    there = by_type([own, endpoint(Kind.PUBLISHER, "turtlesim", "/turtle1/pose")], {TWIST})
    assert did_you_mean_topic(own, there).endswith(
        "which /turtlesim publishes? Write 'pose': a slash in front keeps the namespace out."
    )


def test_a_slash_at_the_other_end() -> None:
    """The node that has it is named; of equally near topics, that of the own namespace is meant."""
    publishers = [endpoint(Kind.PUBLISHER, f"/{n}/pilot", f"/{n}/cmd")._replace(namespace=f"/{n}") for n in "ab"]
    listeners = [endpoint(Kind.SUBSCRIPTION, f"/{n}/robot", "/cmd")._replace(namespace=f"/{n}") for n in "ab"]
    there = by_type([*publishers, *listeners], {TWIST})
    for n, publisher, listener in zip("ab", publishers, listeners, strict=True):
        way = "write 'cmd': a slash in front keeps the namespace out."
        assert did_you_mean_topic(publisher, there).endswith(f"listen? In /{n}/robot {way}")
        assert did_you_mean_topic(listener, there).endswith(
            f"did you mean '/{n}/cmd', which /{n}/pilot publishes? W{way[1:]}"
        )


@pytest.mark.parametrize(
    ("others", "is_told"),
    [
        ([(Kind.PUBLISHER, "talker", "/topic")], True),
        ([(Kind.PUBLISHER, "talker", "/topic"), (Kind.SUBSCRIPTION, "_graphflow_7", "/topic")], True),
        ([(Kind.PUBLISHER, "talker", "/topic"), (Kind.SUBSCRIPTION, "log", "/topic")], False),
        ([(Kind.PUBLISHER, "talker", "/topic"), (Kind.PUBLISHER, "other", "/status")], False),
        ([(Kind.PUBLISHER, "talker", "/topic"), (Kind.SUBSCRIPTION, "other", "/news")], False),
        ([(Kind.PUBLISHER, "listener", "/topic")], False),
        ([], False),
    ],
)
def test_the_only_two_ends_of_a_type(others: list[tuple[Kind, str, str]], is_told: bool) -> None:
    """They probably belong together, whatever they are called; the publisher may well have no listener yet."""
    own = endpoint(Kind.SUBSCRIPTION, "listener", "/chatter")
    ends = [endpoint(*other)._replace(zid=other[1]) for other in others]
    own = own._replace(zid="listener")
    text = did_you_mean_topic(own, by_type([own, *ends], {TWIST}))
    expected = (
        f"nobody publishes /chatter [{TWIST}], and nobody listens to /topic of /talker: if they belong together, give "
        "them one name"
    )
    assert text == (expected if is_told else "")
    if is_told:
        assert did_you_mean_topic(ends[0], by_type([own, *ends], {TWIST})) == ""


def test_what_was_meant_by_a_subscription() -> None:
    """Is told in its words; of several nodes one is named."""
    own = endpoint(Kind.SUBSCRIPTION, "base", "/cmd_vl")
    there = by_type([own, *(endpoint(Kind.PUBLISHER, node, "/cmd_vel") for node in ("b", "a", "c"))], {TWIST})
    assert did_you_mean_topic(own, there) == (
        f"nobody publishes /cmd_vl [{TWIST}]; did you mean '/cmd_vel', which /a and 2 more publish?"
    )


def test_a_node_that_misspells_its_own_topic() -> None:
    """It publishes one and hears the other, and nobody else has either."""
    own, other = endpoint(Kind.PUBLISHER, "base", "/arived"), endpoint(Kind.SUBSCRIPTION, "base", "/arrived")
    assert "did you mean '/arrived', to which /base listens?" in did_you_mean_topic(own, by_type([own, other], {TWIST}))
    fed = endpoint(Kind.PUBLISHER, "arm", "/arrived")
    assert did_you_mean_topic(own, by_type([own, other, fed], {TWIST})) == ""


@pytest.mark.parametrize(
    "other",
    [
        endpoint(Kind.SUBSCRIPTION, "turtlesim", "/cmd_vel"),
        endpoint(Kind.SUBSCRIPTION, "turtlesim", "/pose"),
        endpoint(Kind.SUBSCRIPTION, "relay", "/turtle1/cmd_vel"),
    ],
)
def test_nothing_was_meant(other: Entity) -> None:
    """Where somebody is there, no name is near, or the node uses the other topic itself."""
    own = endpoint(Kind.PUBLISHER, "relay", "/cmd_vel")
    assert did_you_mean_topic(own, by_type([own, other], {TWIST})) == ""


def test_a_crowd_of_names() -> None:
    """Costs so many comparisons at most, and hides no name that was there before; too long names do not count."""
    own = endpoint(Kind.PUBLISHER, "circle", "/cmd_vel")
    crowd = [endpoint(Kind.SUBSCRIPTION, "crowd", f"/other{i}") for i in range(COMPARED)]
    meant = endpoint(Kind.SUBSCRIPTION, "turtlesim", "/cmd_vl")
    long = endpoint(Kind.SUBSCRIPTION, "long", f"/{'a' * MAX_LENGTH}/cmd_vel")
    assert did_you_mean_topic(own, by_type([own, meant, *crowd], {TWIST}))
    assert did_you_mean_topic(own, by_type([own, *crowd, meant], {TWIST})) == ""
    assert did_you_mean_topic(own, by_type([own, long], {TWIST})) == ""


SCAN = "sensor_msgs/msg/LaserScan"


@pytest.mark.parametrize(
    ("asked", "published", "type_", "is_told"),
    [
        ("/laser_scan", ["/scan"], SCAN, True),
        ("/scan", ["/base_scan"], SCAN, True),
        ("/laser_scan", ["/scan", "/rear"], SCAN, False),
        ("/robot2/scan", ["/robot1/scan"], SCAN, False),
        ("/left_scan", ["/right_scan"], SCAN, False),
        ("/cmd_vel_nav", ["/cmd_vel"], TWIST, False),
    ],
)
def test_the_only_sensor_of_its_type(asked: str, published: list[str], type_: str, is_told: bool) -> None:
    """A subscription whose name has a word more or less than that of the only such topic is likely meant for it."""
    own = endpoint(Kind.SUBSCRIPTION, "me", asked, type_)
    there = by_type([own, *(endpoint(Kind.PUBLISHER, "robot", name, type_) for name in published)], {type_})
    text = did_you_mean_topic(own, there)
    assert text == (f"nobody publishes {asked} [{SCAN}]; the only topic of this type is {published[0]!r}" * is_told)
