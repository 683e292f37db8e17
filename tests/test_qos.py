"""Quality of service profiles."""

from __future__ import annotations

import re
from dataclasses import FrozenInstanceError
from typing import Any

import pytest

from graphflow import qos
from graphflow.qos import Durability, History, Liveliness, Qos, Reliability


def test_numbers_are_those_of_rmw() -> None:
    """Each policy has the number that rmw gives it and that stands in tokens."""
    assert (Reliability.RELIABLE, Reliability.BEST_EFFORT) == (1, 2)
    assert (Durability.TRANSIENT_LOCAL, Durability.VOLATILE) == (1, 2)
    assert (History.KEEP_LAST, History.KEEP_ALL) == (1, 2)
    assert (Liveliness.AUTOMATIC, Liveliness.MANUAL_BY_TOPIC) == (1, 3)


def test_no_limit_is_rmws_largest_duration() -> None:
    """No limit is 9223372036 seconds and 854775807 nanoseconds."""
    assert divmod(qos.INFINITE_NS, 10**9) == (9_223_372_036, 854_775_807)


def test_the_default_is_reliable_volatile_and_ten_deep() -> None:
    """The default profile is ROS 2's, without deadline, lifespan or lease."""
    assert (
        Qos()
        == qos.DEFAULT
        == Qos(
            10,
            Reliability.RELIABLE,
            Durability.VOLATILE,
            History.KEEP_LAST,
            qos.INFINITE_NS,
            qos.INFINITE_NS,
            Liveliness.AUTOMATIC,
            qos.INFINITE_NS,
        )
    )


@pytest.mark.parametrize(
    ("profile", "changed"),
    [
        (qos.SENSOR_DATA, {"depth": 5, "reliability": Reliability.BEST_EFFORT}),
        (qos.SERVICES, {}),
        (qos.PARAMETERS, {"depth": 1000}),
        (qos.ROSOUT, {"depth": 1000, "durability": Durability.TRANSIENT_LOCAL, "lifespan_ns": 10 * 10**9}),
    ],
)
def test_presets_are_rmws(profile: Qos, changed: dict[str, Any]) -> None:
    """The presets differ from the default in what rmw says and nothing else."""
    assert profile == Qos(**changed)


def test_a_number_is_a_depth() -> None:
    """A number means the default profile of that depth."""
    assert Qos.of(3) == Qos(depth=3)


def test_a_depth_of_zero_is_rmw_zenohs_default() -> None:
    """Who asks for depth 0 gets the depth rmw_zenoh gives."""
    assert Qos.of(0) == Qos(depth=42)


def test_a_negative_depth_is_refused() -> None:
    """A negative depth is a ValueError that says what to give."""
    with pytest.raises(ValueError, match="cannot be -1; give 1 or more"):
        Qos.of(-1)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (
            {"durability": "transient_local"},
            "durability of a Qos cannot be 'transient_local'; write durability=Durability.TRANSIENT_LOCAL",
        ),
        ({"reliability": "transient_local"}, "write durability=Durability.TRANSIENT_LOCAL"),
        ({"reliability": True}, "reliability of a Qos cannot be True; write reliability=Reliability.RELIABLE"),
        ({"deadline_ns": 0.1}, "is a whole number, not 0.1; for 0.1 seconds write deadline_ns=100_000_000"),
        ({"lifespan_ns": -5}, "lifespan_ns of a Qos cannot be -5; leave it out for none"),
        (
            {"depth": Durability.TRANSIENT_LOCAL},
            "depth of a Qos is a whole number; write durability=Durability.TRANSIENT_LOCAL",
        ),
        ({"lease_ns": "5"}, "lease_ns of a Qos is a whole number, not '5'"),
        ({"depth": True}, "depth of a Qos is a whole number, not True"),
        ({"depth": 2.5}, "depth of a Qos is a whole number, not 2.5"),
    ],
)
def test_values_of_another_kind_are_refused(given: dict[str, Any], told: str) -> None:
    """With the one to write, before anything compares or sends them."""
    with pytest.raises(ValueError, match=re.escape(told)):
        Qos(**given)


def test_a_profile_stays_as_it_is() -> None:
    """A profile is its own short form."""
    assert Qos.of(qos.SENSOR_DATA) is qos.SENSOR_DATA


def test_a_profile_cannot_change() -> None:
    """Profiles are shared, so they are frozen."""
    with pytest.raises(FrozenInstanceError):
        qos.DEFAULT.depth = 5  # type: ignore[misc]
    assert len({Qos(), qos.DEFAULT, qos.SERVICES}) == 1


@pytest.mark.parametrize(
    ("offered", "requested", "policies"),
    [
        (Qos(), Qos(), []),
        (Qos(), qos.SENSOR_DATA, []),
        (qos.SENSOR_DATA, Qos(), ["reliability"]),
        (qos.ROSOUT, Qos(), []),
        (Qos(), qos.ROSOUT, ["durability"]),
        (Qos(), Qos(deadline_ns=1), ["deadline"]),
        (Qos(deadline_ns=2), Qos(deadline_ns=1), ["deadline"]),
        (Qos(deadline_ns=1), Qos(deadline_ns=2), []),
        (Qos(deadline_ns=1), Qos(), []),
        (Qos(), Qos(liveliness=Liveliness.MANUAL_BY_TOPIC), ["liveliness"]),
        (Qos(liveliness=Liveliness.MANUAL_BY_TOPIC), Qos(), []),
        (Qos(lease_ns=2), Qos(lease_ns=1), ["liveliness lease"]),
        (Qos(lifespan_ns=1), Qos(lifespan_ns=2), []),
        (
            qos.SENSOR_DATA,
            Qos(durability=Durability.TRANSIENT_LOCAL, deadline_ns=1),
            ["reliability", "durability", "deadline"],
        ),
    ],
)
def test_dds_refuses_less_than_is_asked_for(offered: Qos, requested: Qos, policies: list[str]) -> None:
    """A publisher must offer at least what a subscription asks for, policy by policy."""
    assert qos.incompatible(offered, requested) == policies


@pytest.mark.parametrize(
    ("others", "reliability", "durability"),
    [
        ([], Reliability.RELIABLE, Durability.VOLATILE),
        ([Qos()], Reliability.RELIABLE, Durability.VOLATILE),
        ([qos.SENSOR_DATA], Reliability.BEST_EFFORT, Durability.VOLATILE),
        ([qos.ROSOUT], Reliability.RELIABLE, Durability.TRANSIENT_LOCAL),
        ([qos.ROSOUT, qos.SENSOR_DATA], Reliability.BEST_EFFORT, Durability.VOLATILE),
    ],
)
def test_best_available_is_the_strongest_that_fits_all(
    others: list[Qos], reliability: Reliability, durability: Durability
) -> None:
    """BEST_AVAILABLE becomes what every counterpart that is there can meet; other policies stay."""
    settled = qos.BEST_AVAILABLE.adapted(others)
    assert settled == Qos(reliability=reliability, durability=durability)
    assert Qos(depth=3).adapted(others) == Qos(depth=3)


def test_ros_names_of_the_profiles() -> None:
    """Each profile is found by the name that ROS 2's command line has for it."""
    assert list(qos.PROFILES) == [
        *("default", "sensor_data", "services_default", "parameters", "parameter_events", "action_status_default"),
        *("rosout_default", "best_available", "system_default"),
    ]
    assert qos.PROFILES["sensor_data"].reliability is Reliability.BEST_EFFORT
    assert qos.PROFILES["system_default"].depth == qos.DEFAULT_DEPTH


def test_what_is_on_offer() -> None:
    """In the words of policies; a span of time in seconds."""
    offered = Qos(reliability=Reliability.BEST_EFFORT, deadline_ns=500_000_000)
    words = qos.on_offer(offered, ("reliability", "durability", "deadline", "liveliness", "liveliness lease"))
    assert words == (
        "reliability BEST_EFFORT, durability VOLATILE, deadline 0.5 s, liveliness AUTOMATIC, liveliness lease infinite"
    )
