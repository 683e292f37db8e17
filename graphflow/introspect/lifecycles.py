"""Lifecycle nodes: read their states and trigger transitions."""

from __future__ import annotations

from typing import Any

from graphflow.introspect.graph_view import View
from graphflow.machines.cache import GraphCache
from graphflow.wire.liveliness import Kind

_CHANGE = "lifecycle_msgs/srv/ChangeState"
_STATE = "lifecycle_msgs/srv/GetState"
_TRANSITIONS = "lifecycle_msgs/srv/GetAvailableTransitions"


def managed_nodes(cache: GraphCache) -> list[str]:
    """Return the full names of the lifecycle nodes, including hidden ones."""
    servers = cache.endpoints(Kind.SERVICE)
    return sorted({e.node_name for e in servers if e.type == _CHANGE and e.name == f"{e.node_name}/change_state"})


def state(view: View, node: str, timeout: float) -> Any:
    """Return the state of a node. Raises CallError: It does not answer."""
    from graphflow.msgs.lifecycle_msgs.srv import GetState

    return view.call(f"{node}/get_state", _STATE, GetState.Request(), timeout).current_state


def transitions(view: View, node: str, timeout: float, *, everything: bool = False) -> Any:
    """Return the transitions that a node can make from its current state.

    Args:
        everything: Whether to return the transitions of all states.

    Raises:
        CallError: It does not answer.
    """
    from graphflow.msgs.lifecycle_msgs.srv import GetAvailableTransitions

    service = f"{node}/{'get_transition_graph' if everything else 'get_available_transitions'}"
    return view.call(service, _TRANSITIONS, GetAvailableTransitions.Request(), timeout).available_transitions


def change(view: View, node: str, transition: Any, timeout: float) -> bool:
    """Trigger a transition of a node; return False if it fails, as the node's log explains.

    Args:
        transition: A `lifecycle_msgs/msg/Transition`.

    Raises:
        CallError: It does not answer.
    """
    from graphflow.msgs.lifecycle_msgs.srv import ChangeState

    request = ChangeState.Request(transition=transition)
    return bool(view.call(f"{node}/change_state", _CHANGE, request, timeout).success)
