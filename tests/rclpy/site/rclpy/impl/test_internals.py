"""What a node has."""

from rclpy.node import Node


def test_it_is_there_to_be_looked_at(node: Node) -> None:
    """While it is added to; by names that cannot be assigned."""
    timer, guard = node.create_timer(1.0, print), node.create_guard_condition(print)
    assert list(node.timers) == [timer]
    assert list(node.guards) == [guard]
    assert node.default_callback_group.has_entity(timer)
    for _ in node.timers:
        node.create_timer(1.0, print)
        break
    assert len(list(node.timers)) == 2
