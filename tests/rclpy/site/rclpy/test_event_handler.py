"""What endpoints notice about each other."""

from __future__ import annotations

from typing import Any

import pytest
from std_msgs.msg import Int32, String

import rclpy
from graphflow.runtime.endpoints.events import QosEvent
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.event_handler import (
    EventHandler,
    PublisherEventCallbacks,
    QoSPublisherEventType,
    QoSSubscriptionEventType,
    SubscriptionEventCallbacks,
)
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSPolicyKind, QoSProfile, qos_profile_sensor_data
from tests.rclpy.conftest import Spinner


def test_matches_are_told_to_both_sides(node: Node, spin: Spinner) -> None:
    """When somebody comes, and when somebody goes."""
    told: list[Any] = []
    node.create_publisher(String, "t", 1, event_callbacks=PublisherEventCallbacks(matched=told.append))
    subscription = node.create_subscription(
        String, "t", print, 1, event_callbacks=SubscriptionEventCallbacks(matched=told.append)
    )
    spin(lambda: len(told) == 2)
    assert [(info.current_count, info.current_count_change) for info in told] == [(1, 1), (1, 1)]
    node.destroy_subscription(subscription)
    spin(lambda: len(told) == 3)
    assert (told[2].current_count, told[2].current_count_change, told[2].total_count) == (0, -1, 1)


def test_what_does_not_fit_is_told_by_policy(node: Node, spin: Spinner) -> None:
    """To whom asked; the others have it logged."""
    told: list[Any] = []
    events = SubscriptionEventCallbacks(incompatible_qos=told.append, incompatible_type=told.append)
    wanted = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(String, "t", print, wanted, event_callbacks=events)
    node.create_publisher(String, "t", 1)
    spin(lambda: told)
    assert told[0].last_policy_kind is QoSPolicyKind.DURABILITY
    node.create_publisher(Int32, "t", 1)
    spin(lambda: len(told) == 2)
    assert told[1].total_count == 1


def test_what_does_not_fit_is_logged_with_one_remedy(
    node: Node, spin: Spinner, caplog: pytest.LogCaptureFixture
) -> None:
    """Of two nodes of a process, one says it: messages pass, and what to change where they would not."""

    def told() -> list[str]:
        return [record.getMessage() for record in caplog.records if record.levelname == "WARNING"]

    node.create_subscription(String, "t", print, 1)
    Node("other").create_publisher(String, "t", qos_profile_sensor_data)
    spin(lambda: len(told()) == 1)
    rclpy.spin_once(node, timeout_sec=0.05)
    assert told() == [
        "/t: the publisher of /other offers less than the subscription of /node asks for: reliability. Over Zenoh "
        "messages pass; over DDS none would: have the subscription ask for reliability BEST_EFFORT, as in "
        "create_subscription(String, '/t', callback, qos_profile_sensor_data), from rclpy.qos"
    ]


def test_a_deadline_that_is_missed_is_told(node: Node, spin: Spinner) -> None:
    """To both sides."""
    told, strict = list[str](), QoSProfile(depth=1, deadline=Duration(seconds=0.05))
    missed = PublisherEventCallbacks(deadline=lambda info: told.append("offered"))
    node.create_publisher(String, "t", strict, event_callbacks=missed)
    wanted = SubscriptionEventCallbacks(deadline=lambda info: told.append("requested"))
    node.create_subscription(String, "t", print, strict, event_callbacks=wanted)
    spin(lambda: {"offered", "requested"} <= {*told})


def test_without_default_callbacks_nothing_is_looked_after(node: Node) -> None:
    """By default, what does not fit."""
    made = node.create_publisher(String, "t", 1)
    assert len(made.event_handlers) == 2
    bare = PublisherEventCallbacks(use_default_callbacks=False)
    assert node.create_publisher(String, "t", 1, event_callbacks=bare).event_handlers == []


def test_several_events_are_told_as_one() -> None:
    """In rcl's records."""

    def told(event_type: Any, *events: QosEvent) -> Any:
        handler = EventHandler(callback_group=ReentrantCallbackGroup(), callback=print, event_type=event_type)
        for event in events:
            handler.notice(event)
        assert handler.is_ready(None)
        info = handler.take_data()
        assert not handler.is_ready(None)
        return info

    came, gone = QosEvent("liveliness_changed", 1, 1, 1), QosEvent("liveliness_changed", 2, -1, 0)
    info = told(QoSSubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED, came, gone)
    assert (info.alive_count, info.not_alive_count, info.alive_count_change) == (0, 1, 0)
    lost = told(
        QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST,
        QosEvent("message_lost", 2, 2),
        QosEvent("message_lost", 5, 3),
    )
    assert lost == (5, 5)
    assert told(QoSPublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST, QosEvent("liveliness_lost", 1)) == (1, 1)
    handler = EventHandler(
        callback_group=ReentrantCallbackGroup(),
        callback=print,
        event_type=QoSPublisherEventType.RCL_PUBLISHER_MATCHED,
    )
    handler.destroy()
    handler.notice(came)
    assert not handler.is_ready(None)
