"""Lifecycle nodes: read their states and trigger transitions."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, NamedTuple

from graphflow.errors import CallError
from graphflow.introspect.graph_view import View
from graphflow.machines.cache import GraphCache
from graphflow.machines.lifecycle import LifecycleState, commands
from graphflow.names import is_hidden
from graphflow.wire.liveliness import Kind

if TYPE_CHECKING:
    from collections.abc import Container, Sequence

    from graphflow.msgs.lifecycle_msgs.msg import State, Transition, TransitionDescription

ROUNDS = 10
"""Timeouts that `idle` spends on all nodes together, so that silent nodes cannot hold it up."""

_CHANGE = "lifecycle_msgs/srv/ChangeState"
_STATE = "lifecycle_msgs/srv/GetState"
_TRANSITIONS = "lifecycle_msgs/srv/GetAvailableTransitions"


def managed_nodes(cache: GraphCache) -> list[str]:
    """Return the full names of the lifecycle nodes, including hidden ones."""
    servers = cache.endpoints(Kind.SERVICE)
    return sorted({e.node_name for e in servers if e.type == _CHANGE and e.name == f"{e.node_name}/change_state"})


def state(view: View, node: str, timeout: float) -> State:
    """Return the state of a node. Raises CallError: It does not answer."""
    from graphflow.msgs.lifecycle_msgs.srv import GetState

    response: GetState.Response = view.call(f"{node}/get_state", _STATE, GetState.Request(), timeout)
    return response.current_state


class Idle(NamedTuple):
    """The lifecycle nodes that do nothing yet, and those whose states are not known."""

    hints: list[str]
    """A sentence for each node that is not active, with the commands that activate it."""
    unknown: list[str]
    """The names of the nodes that did not answer, or were not asked for lack of time."""


def idle(view: View, timeout: float, among: Container[str] | None = None) -> Idle:
    """Find the lifecycle nodes that are not active; hidden ones are left out.

    Args:
        timeout: Seconds to wait for one node; all together get `ROUNDS` times as long.
        among: The nodes that are asked; all if None.
    """
    end = time.monotonic() + ROUNDS * timeout
    found = Idle([], [])
    for node in managed_nodes(view.cache):
        if is_hidden(node) or (among is not None and node not in among):
            continue
        try:
            now = LifecycleState(state(view, node, timeout).id) if time.monotonic() < end else None
        except (CallError, ValueError):
            now = None
        if now is None:
            found.unknown.append(node)
        elif way := commands(node, now):
            found.hints.append(f"{node} is {now.label}, not active: {way}")
    return found


def transitions(view: View, node: str, timeout: float, *, everything: bool = False) -> Sequence[TransitionDescription]:
    """Return the transitions that a node can make from its current state.

    Args:
        everything: Whether to return the transitions of all states.

    Raises:
        CallError: It does not answer.
    """
    from graphflow.msgs.lifecycle_msgs.srv import GetAvailableTransitions

    service = f"{node}/{'get_transition_graph' if everything else 'get_available_transitions'}"
    response: GetAvailableTransitions.Response
    response = view.call(service, _TRANSITIONS, GetAvailableTransitions.Request(), timeout)
    return response.available_transitions


def change(view: View, node: str, transition: Transition, timeout: float) -> bool:
    """Trigger a transition of a node; return False if it fails, as the node's log explains.

    Args:
        transition: One of those that `transitions` returns.

    Raises:
        CallError: It does not answer.
    """
    from graphflow.msgs.lifecycle_msgs.srv import ChangeState

    request = ChangeState.Request(transition=transition)
    return bool(view.call(f"{node}/change_state", _CHANGE, request, timeout).success)
