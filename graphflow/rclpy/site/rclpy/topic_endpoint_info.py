"""Information on the endpoints of a topic."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from rclpy.qos import QoSProfile, qos_profile_unknown
from rclpy.type_hash import TypeHash


class TopicEndpointTypeEnum(IntEnum):
    """The kinds of endpoints."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


def _checked(name: str, kind: type) -> property:
    slot = f"_{name}"

    def get(self: Any) -> Any:
        return getattr(self, slot)

    def put(self: Any, value: Any) -> None:
        if kind is TopicEndpointTypeEnum and isinstance(value, int):
            value = TopicEndpointTypeEnum(value)
        if kind is QoSProfile and isinstance(value, dict):
            value = QoSProfile(**value)
        if kind is TypeHash and isinstance(value, dict):
            value = TypeHash(**value)
        assert isinstance(value, kind)
        setattr(self, slot, value)

    return property(get, put)


class TopicEndpointInfo:
    """An endpoint of a topic."""

    __slots__ = (
        *("_endpoint_gid", "_endpoint_type", "_node_name", "_node_namespace", "_qos_profile", "_topic_type"),
        "_topic_type_hash",
    )

    def __init__(self, **kwargs: object) -> None:
        assert all(f"_{key}" in self.__slots__ for key in kwargs), f"Invalid arguments passed to constructor: {kwargs}"
        self.node_name = kwargs.get("node_name", "")
        self.node_namespace = kwargs.get("node_namespace", "")
        self.topic_type = kwargs.get("topic_type", "")
        self.topic_type_hash = kwargs.get("topic_type_hash", TypeHash())
        self.endpoint_type = kwargs.get("endpoint_type", TopicEndpointTypeEnum.INVALID)
        self.endpoint_gid = kwargs.get("endpoint_gid", [])
        self.qos_profile = kwargs.get("qos_profile", QoSProfile(**qos_profile_unknown.to_dict()))

    node_name = _checked("node_name", str)
    node_namespace = _checked("node_namespace", str)
    topic_type = _checked("topic_type", str)
    topic_type_hash = _checked("topic_type_hash", TypeHash)
    endpoint_type = _checked("endpoint_type", TopicEndpointTypeEnum)
    endpoint_gid = _checked("endpoint_gid", list)
    qos_profile = _checked("qos_profile", QoSProfile)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TopicEndpointInfo):
            return False
        return all(getattr(self, slot) == getattr(other, slot) for slot in self.__slots__)

    __hash__ = None  # type: ignore[assignment]  # it can change

    def __str__(self) -> str:
        gid = ".".join(format(byte, "02x") for byte in self.endpoint_gid)
        qos = self.qos_profile
        depth = f" ({qos.depth})" if qos.history.name == "KEEP_LAST" else ""
        return (
            f"Node name: {self.node_name}\n"
            f"Node namespace: {self.node_namespace}\n"
            f"Topic type: {self.topic_type}\n"
            f"Topic type hash: {self.topic_type_hash}\n"
            f"Endpoint type: {self.endpoint_type.name}\n"
            f"GID: {gid}\n"
            f"QoS profile:\n"
            f"  Reliability: {qos.reliability.name}\n"
            f"  History (Depth): {qos.history.name}{depth}\n"
            f"  Durability: {qos.durability.name}\n"
            f"  Lifespan: {qos.lifespan}\n"
            f"  Deadline: {qos.deadline}\n"
            f"  Liveliness: {qos.liveliness.name}\n"
            f"  Liveliness lease duration: {qos.liveliness_lease_duration}"
        )
