"""Publishers and subscriptions of serialized messages: of any type, also one whose definition is not known here.

Recorders, players and meters use them: nothing is decoded.
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
    """A subscription of serialized messages.

    Args:
        type_name: `package/msg/Name`.
        topic: Its full name; it is not remapped.
        callback: Called on the loop with each message, and not in a group: it must not wait.
        type_hash: RIHS01 of the type, where its definition is not known here.
        on_event: Called with each `QosEvent`.

    Raises:
        UnknownInterface: The type's name is none.
        InvalidName: The topic's is none.
    """
    core = _checked(node, type_name, topic)
    return core.add(RawSubscription(core, type_name, topic, qos, callback, type_hash, on_event))


def advertise(
    node: Node, type_name: str, topic: str, qos: Qos, *, type_hash: str = "", on_event: OnEvent | None = None
) -> RawPublisher:
    """A publisher of serialized messages. Arguments and errors as for `subscribe`."""
    core = _checked(node, type_name, topic)
    return core.add(RawPublisher(core, type_name, topic, qos, type_hash, on_event))


def _checked(node: Node, type_name: str, topic: str) -> NodeCore:
    """The node's core, if topic and type may be the names of some: others announce what they like."""
    check_full_name(topic)
    if len(type_name.split("/")) != 3:
        raise UnknownInterface(f"{printable(type_name)!r} is not an interface name")
    return core_of(node)
