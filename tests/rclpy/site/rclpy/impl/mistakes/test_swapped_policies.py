"""Policies of one kind that are given as another."""

from __future__ import annotations

import pytest

from graphflow.qos import Durability
from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy


def test_a_policy_of_another_kind(caplog: pytest.LogCaptureFixture) -> None:
    """It is told once, with the line that gives it; the number counts, as in ROS 2."""
    for _ in range(2):
        profile = QoSProfile(depth=10, durability=ReliabilityPolicy.BEST_EFFORT)
        profile.reliability = DurabilityPolicy.TRANSIENT_LOCAL  # type: ignore[assignment]  # the mistake
        QoSProfile(depth=HistoryPolicy.KEEP_LAST)
    assert (profile.durability, profile.reliability) == (DurabilityPolicy.VOLATILE, ReliabilityPolicy.RELIABLE)
    line = test_a_policy_of_another_kind.__code__.co_firstlineno + 3
    numbers = ", since only the number counts: write"
    assert caplog.messages == [
        f"test_swapped_policies.py:{line}: durability=ReliabilityPolicy.BEST_EFFORT is read as "
        f"DurabilityPolicy.VOLATILE{numbers} reliability=ReliabilityPolicy.BEST_EFFORT",
        f"test_swapped_policies.py:{line + 1}: reliability=DurabilityPolicy.TRANSIENT_LOCAL is read as "
        f"ReliabilityPolicy.RELIABLE{numbers} durability=DurabilityPolicy.TRANSIENT_LOCAL",
        f"test_swapped_policies.py:{line + 2}: depth=HistoryPolicy.KEEP_LAST is read as 1{numbers} "
        "history=HistoryPolicy.KEEP_LAST",
    ]


def test_what_is_meant(caplog: pytest.LogCaptureFixture) -> None:
    """Numbers, graphflow's own values, and what all kinds have under one number, are left alone."""
    QoSProfile(depth=1, durability=2, reliability=1)
    QoSProfile(depth=1, durability=Durability.VOLATILE)
    QoSProfile(
        depth=1,
        history=HistoryPolicy.KEEP_ALL,
        reliability=DurabilityPolicy.SYSTEM_DEFAULT,
        durability=ReliabilityPolicy.BEST_AVAILABLE,
        liveliness=LivelinessPolicy.AUTOMATIC,
    )
    assert caplog.messages == []
