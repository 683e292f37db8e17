"""Messages as CDR."""

from std_msgs.msg import String

from rclpy.serialization import deserialize_message, serialize_message


def test_a_message_comes_back() -> None:
    """From its bytes."""
    payload = serialize_message(String(data="a"))
    assert payload == b"\0\1\0\0\2\0\0\0a\0"
    assert deserialize_message(payload, String) == String(data="a")
