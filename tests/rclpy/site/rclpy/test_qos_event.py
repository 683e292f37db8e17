"""The former name of a module."""

from rclpy import event_handler, qos_event


def test_it_has_what_the_new_one_has() -> None:
    """For code that has not moved."""
    assert qos_event.QoSEventHandler is event_handler.EventHandler
    assert qos_event.SubscriptionEventCallbacks is event_handler.SubscriptionEventCallbacks
