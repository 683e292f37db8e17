"""What is published of calls."""

from rclpy.service_introspection import ServiceIntrospectionState


def test_the_states_have_rcls_numbers() -> None:
    """Parameters of demos name them by these."""
    assert [(state.name, state.value) for state in ServiceIntrospectionState] == [
        ("OFF", 0),
        ("METADATA", 1),
        ("CONTENTS", 2),
    ]
