"""Publishers and subscriptions of serialized messages of any type, even without its definition.

Bag recording, bag playback and topic statistics use them: nothing is decoded.
"""

from __future__ import annotations

from graphflow.errors import UnknownInterface, printable
from graphflow.names import check_full_name
from graphflow.qos import Qos
from graphflow.runtime.endpoints.events import OnEvent
from graphflow.runtime.endpoints.serialized import Callback, RawPublisher, RawSubscription
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import NodeCore, core_of


def subscribe(
    node: Node,
    type_name: str,
    topic: str,
    callback: Callback,
    qos: Qos,
    *,
    type_hash: str = "",
    on_event: OnEvent | None = None,
) -> RawSubscription:
    """Create a subscription of serialized messages.

    Args:
        type_name: `package/msg/Name`.
        topic: The full name, which is not remapped.
        callback: Called on the loop with each message, outside any group: it must not block.
        type_hash: The type's RIHS01 hash, if its definition is not known here.
        on_event: Called with each `QosEvent`.

    Raises:
        UnknownInterface: `type_name` is not the name of a type.
        InvalidName: `topic` is not a legal name.
    """
    core = _checked(node, type_name, topic)
    return core.add(RawSubscription(core, type_name, topic, qos, callback, type_hash, on_event))


def advertise(
    node: Node, type_name: str, topic: str, qos: Qos, *, type_hash: str = "", on_event: OnEvent | None = None
) -> RawPublisher:
    """Create a publisher of serialized messages. Arguments and errors as for `subscribe`."""
    core = _checked(node, type_name, topic)
    return core.add(RawPublisher(core, type_name, topic, qos, type_hash, on_event))


def _checked(node: Node, type_name: str, topic: str) -> NodeCore:
    """Return the node's core after checking both names, which may come from other participants."""
    check_full_name(topic)
    if len(type_name.split("/")) != 3:
        raise UnknownInterface(f"{printable(type_name)!r} is not an interface name")
    return core_of(node)
