"""Hidden names."""

from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden


def test_a_part_with_an_underscore_hides_a_name() -> None:
    """At its beginning."""
    assert topic_or_service_is_hidden("/a/_b/c")
    assert not topic_or_service_is_hidden("/a/b_/c")
