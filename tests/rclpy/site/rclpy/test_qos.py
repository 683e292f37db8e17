"""Quality of service."""

from __future__ import annotations

from typing import Any

import pytest

from graphflow.qos import INFINITE_NS, Durability, History, Liveliness, Qos, Reliability
from rclpy import qos
from rclpy.duration import Duration
from rclpy.qos import QoSProfile


def test_a_profile_needs_a_depth_or_another_history() -> None:
    """And knows no other words."""
    assert QoSProfile(depth=3).history is qos.HistoryPolicy.KEEP_LAST
    assert QoSProfile(history=qos.HistoryPolicy.KEEP_ALL).depth == 0
    with pytest.raises(qos.InvalidQoSProfileException, match="required"):
        QoSProfile()
    with pytest.raises(qos.InvalidQoSProfileException, match="without a depth"):
        QoSProfile(history=qos.HistoryPolicy.KEEP_LAST)
    with pytest.raises(AssertionError):
        QoSProfile(depth=1, speed=3)
    with pytest.raises(ValueError, match="greater than or equal to zero"):
        QoSProfile(depth=-1)
    with pytest.warns(UserWarning, match="zero depth") as warned:
        QoSProfile(depth=0)
    assert [warning.filename for warning in warned] == [__file__]  # the line that gives it


def test_profiles_are_compared_by_their_policies() -> None:
    """And made from those of another."""
    one = QoSProfile(depth=1, deadline=Duration(seconds=1))
    assert one == QoSProfile(**one.to_dict())
    assert one != QoSProfile(depth=1)
    assert "depth=1" in str(one)


def test_policies_have_short_names() -> None:
    """For command lines."""
    assert qos.ReliabilityPolicy.get_from_short_key("best_effort") is qos.ReliabilityPolicy.BEST_EFFORT
    assert qos.QoSPresetProfiles.get_from_short_key("sensor_data") is qos.qos_profile_sensor_data
    assert "keep_last" in qos.HistoryPolicy.short_keys()
    assert qos.qos_policy_name_from_kind(2) == "DURABILITY"


def test_a_profile_goes_to_graphflow_and_back() -> None:
    """What is left open is the default there."""
    mine = QoSProfile(
        depth=4,
        reliability=qos.ReliabilityPolicy.BEST_EFFORT,
        durability=qos.DurabilityPolicy.TRANSIENT_LOCAL,
        deadline=Duration(seconds=1),
        liveliness=qos.LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=2),
    )
    theirs = qos.to_graphflow(mine)
    assert theirs == Qos(
        4,
        Reliability.BEST_EFFORT,
        Durability.TRANSIENT_LOCAL,
        History.KEEP_LAST,
        10**9,
        INFINITE_NS,
        Liveliness.MANUAL_BY_TOPIC,
        2 * 10**9,
    )
    back = qos.from_graphflow(theirs)
    assert (back.depth, back.deadline, back.liveliness) == (4, Duration(seconds=1), mine.liveliness)
    assert qos.to_graphflow(qos.qos_profile_system_default).reliability is Reliability.RELIABLE
    assert qos.to_graphflow(qos.qos_profile_best_available).durability is Durability.BEST_AVAILABLE


@pytest.mark.parametrize(
    ("offered", "wanted", "verdict"),
    [
        ({}, {}, "OK"),
        ({"reliability": qos.ReliabilityPolicy.BEST_EFFORT}, {}, "ERROR"),
        ({}, {"durability": qos.DurabilityPolicy.TRANSIENT_LOCAL}, "ERROR"),
        ({}, {"deadline": Duration(seconds=1)}, "ERROR"),
        ({"reliability": qos.ReliabilityPolicy.SYSTEM_DEFAULT}, {}, "WARNING"),
    ],
)
def test_what_would_not_find_each_other_under_dds(
    offered: dict[str, object], wanted: dict[str, object], verdict: str
) -> None:
    """With the reason."""
    found, reason = qos.qos_check_compatible(QoSProfile(depth=1, **offered), QoSProfile(depth=1, **wanted))
    assert found.name == verdict
    assert bool(reason) == (verdict != "OK")


def test_a_number_is_a_depth() -> None:
    """And nothing else is a profile."""
    assert qos.validated(3) == QoSProfile(depth=3)
    with pytest.raises(ValueError, match="greater than or equal to zero"):
        qos.validated(-1)
    with pytest.raises(TypeError, match="Expected QoSProfile or int"):
        qos.validated("deep")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("policy", "former", "name"),
    [
        (qos.QoSReliabilityPolicy, "RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT", "BEST_EFFORT"),
        (qos.HistoryPolicy, "RMW_QOS_POLICY_HISTORY_KEEP_LAST", "KEEP_LAST"),
        (qos.DurabilityPolicy, "RMW_QOS_POLICY_DURABILITY_VOLATILE", "VOLATILE"),
        (qos.LivelinessPolicy, "RMW_QOS_POLICY_LIVELINESS_AUTOMATIC", "AUTOMATIC"),
    ],
)
def test_former_names_of_values(policy: type[qos.QoSPolicyEnum], former: str, name: str) -> None:
    """Are known, and warned of."""
    with pytest.warns(UserWarning, match=f"it is {policy.__name__}.{name} now"):
        assert getattr(policy, former) is policy[name]
    assert not hasattr(policy, f"{former}_NOT")


@pytest.mark.parametrize(
    ("given", "text"),
    [
        (
            {"durability": "transient_local"},
            "must be a DurabilityPolicy, got 'transient_local': write DurabilityPolicy.TRANS",
        ),
        (
            {"reliability": "fast"},
            "reliability must be a ReliabilityPolicy, got 'fast': write ReliabilityPolicy.RELIABLE",
        ),
        ({"deadline": 0.5}, "deadline must be a Duration, got 0.5: write Duration(seconds=0.5)"),
        ({"depth": "1"}, "depth must be an int, got '1': write 10"),
    ],
)
def test_values_of_other_types(given: dict[str, Any], text: str) -> None:
    """They are refused with what to write."""
    with pytest.raises(AssertionError) as caught:
        QoSProfile(**{"depth": 1, **given})
    assert text in str(caught.value)
