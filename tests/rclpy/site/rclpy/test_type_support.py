"""Interface classes."""

import pytest
from std_msgs.msg import String
from std_srvs.srv import Empty

from rclpy.exceptions import NoTypeSupportImportedException
from rclpy.type_support import check_for_type_support, check_is_valid_msg_type, check_is_valid_srv_type


class Meta(type):
    _TYPE_SUPPORT = None

    @classmethod
    def __import_type_support__(cls) -> None:
        """Nothing is found."""


class Without(metaclass=Meta):
    """A class whose support is missing."""


def test_messages_and_services_are_told_apart() -> None:
    """And from all else."""
    check_is_valid_msg_type(String)
    check_is_valid_srv_type(Empty)
    with pytest.raises(RuntimeError, match="message type"):
        check_is_valid_msg_type(Empty)
    with pytest.raises(RuntimeError, match="service type"):
        check_is_valid_srv_type(String)
    with pytest.raises(AttributeError, match="ROS 1"):
        check_for_type_support(object())
    with pytest.raises(NoTypeSupportImportedException):
        check_for_type_support(Without)
