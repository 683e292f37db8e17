"""The roles of nodes' entities, their pending arrivals, and the calls or goals that running callbacks serve."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from types import CellType
from typing import TYPE_CHECKING, NamedTuple

from graphflow.analysis.class_source import ANSWERED
from graphflow.analysis.frames import Frame, awaited, suspended
from graphflow.analysis.user_code import is_ours
from graphflow.errors import ClosedError, ServerLost
from graphflow.machines.waits.wait_graph import goal_id
from graphflow.runtime.endpoints.threaded import Asked, ThreadedClient, ThreadedService, read_request
from rclpy.action.client import ActionClient
from rclpy.action.server import ActionServer, ServerGoalHandle
from rclpy.client import Client
from rclpy.guard_condition import GuardCondition
from rclpy.impl.nodes import internals_of
from rclpy.impl.spinning import Entity, Run
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Rate, Timer

if TYPE_CHECKING:
    from graphflow.rclpy.wake import Wake
    from rclpy.node import Node
    from rclpy.task import Future


class Role(NamedTuple):
    """The role of an entity: `timer tick`."""

    kind: str
    handler: str
    """The name of its callback; for a client, of its service or action."""
    is_inner: bool = False
    """Whether it is graphflow's own and not user-defined."""

    @property
    def label(self) -> str:
        return f"{self.kind} {self.handler}"


_KINDS = {Timer: "timer", Subscription: "subscription", Service: "service", GuardCondition: "guard_condition"}


def role_of(entity: Entity) -> Role:
    """Return the role of an entity."""
    if isinstance(entity, Client):
        return Role("reply", entity.endpoint.name)
    if isinstance(entity, ActionClient):
        return Role("reply", action_of(entity))
    if isinstance(entity, ActionServer):
        return Role("action", name_of(callbacks_of(entity).execute) or internals_of(entity).action_name)
    kind = next((word for cls, word in _KINDS.items() if isinstance(entity, cls)), "waitable")
    callback = callback_of(entity)
    if isinstance(getattr(callback, "__self__", None), Rate):
        return Role("timer", "rate", is_inner=True)
    code = getattr(callback, "__code__", None)
    is_inner = code is not None and is_ours(code.co_filename)
    is_inner |= kind == "waitable" and type(entity).__module__.startswith("rclpy.")
    if is_inner and isinstance(entity, (Service, Subscription)):
        return Role(kind, entity.endpoint.name.rpartition("/")[2], is_inner=True)  # for example change_state, or tf
    return Role(kind, name_of(callback) or type(entity).__name__, is_inner)


def callback_of(entity: Entity) -> object:
    """Return the callback of an entity that has one; else None."""
    return getattr(entity, "callback", None)


def name_of(callback: object) -> str:
    """Return a function's name; empty for other callables."""
    # Programs bind arguments with `functools.partial`, which has no name of its own.
    while isinstance(callback, partial):
        callback = callback.func
    return str(getattr(callback, "__name__", ""))


def method_of(callback: object, node: Node | None) -> str:
    """Return the method that a callback calls: `tick` of the node, `rate.fire` of the object in `self.rate`; or ""."""
    while isinstance(callback, partial):
        callback = callback.func
    owner, name = getattr(callback, "__self__", None), name_of(callback)
    if owner is None or node is None:
        return ""
    if owner is node:
        return name
    attribute = next((attribute for attribute, value in list(vars(node).items()) if value is owner), "")
    return f"{attribute}.{name}" if attribute else ""


def full_name(node: Node | None) -> str:
    """Return a node's name with its namespace; empty for no node."""
    return "" if node is None else str(internals_of(node).node.full_name)


def entities_of(node: Node) -> Iterator[Entity]:
    """Return the node's entities that have callbacks."""
    kinds: tuple[Iterator[Entity], ...] = (node.subscriptions, node.clients, node.services, node.timers)
    for kind in (*kinds, node.guards, node.waitables):
        yield from list(kind)


def arrived(entity: Entity) -> tuple[tuple[str, ...], int]:
    """Return the calls that have arrived for an entity, or whose answers have, and the number of all arrivals."""
    if isinstance(entity, Service):
        return _requests(entity.endpoint)
    if isinstance(entity, ActionServer):
        parts = [_requests(service) for service in internals_of(entity).services]
        return tuple(call for calls, _ in parts for call in calls), sum(number for _, number in parts)
    if isinstance(entity, (Client, ActionClient)):
        parts = [_answers(client) for client in clients_of(entity)]
        return tuple(call for calls, _ in parts for call in calls), sum(number for _, number in parts)
    return (), entity.endpoint.waiting if isinstance(entity, Subscription) else 0


def clients_of(entity: Client | ActionClient) -> tuple[ThreadedClient, ...]:
    """Return the endpoints by which a client calls: its own, or those of an action's three services."""
    return (entity.endpoint,) if isinstance(entity, Client) else internals_of(entity).clients


def wakes_of(entity: Client | ActionClient) -> list[Wake]:
    """Return the wake-ups of the threads that wait for a client's server."""
    return list(entity.server_wakes if isinstance(entity, Client) else internals_of(entity).server_wakes)


def action_of(entity: ActionClient | ActionServer) -> str:
    """Return the full name of an action."""
    return internals_of(entity).full_name


def _requests(endpoint: ThreadedService) -> tuple[tuple[str, ...], int]:
    # A copy: other threads append meanwhile.
    items = list(endpoint.inbox.items)
    return tuple(asked.call for asked in map(read_request, items) if asked is not None), len(items)


def _answers(endpoint: ThreadedClient) -> tuple[tuple[str, ...], int]:
    # A lost call is not an answer: its future is never done.
    items = [answered for answered in list(endpoint.inbox.items) if not isinstance(answered.error, ServerLost)]
    try:
        return tuple(endpoint.call_id(answered.sequence) for answered in items), len(items)
    except ClosedError:
        return (), len(items)


def after_answers(entity: Entity, node: Node | None) -> Iterator[str]:
    """Return the methods of the node, or of objects in it, that run after an answer for which a client waits."""
    futures: list[Future] = []
    if isinstance(entity, Client):
        futures = list(entity.pending_requests.values())
    elif isinstance(entity, ActionClient):
        futures = [future for future, _ in list(internals_of(entity).waiting.values())]
    for future in futures:
        for callback in future.done_callbacks():
            if method := method_of(callback, node):
                yield method
            elif any(_content(cell) is node for cell in getattr(callback, "__closure__", None) or ()):
                yield ANSWERED


def _content(cell: CellType) -> object:
    """Return the value of a closure's variable; None before it is bound."""
    try:
        return cell.cell_contents
    except ValueError:
        return None


def result_requests(entity: Entity) -> Iterator[tuple[str, str]]:
    """Return the calls that request results from an action server, each with its goal."""
    if isinstance(entity, ActionServer):
        for goal in list(internals_of(entity).handles.values()):
            if not goal.result_future.done():
                yield from ((asked.call, goal_id(bytes(goal.goal_id.uuid))) for asked in list(goal.result_requests))


def goal_of(run: Run) -> ServerGoalHandle | None:
    """Return the goal whose body a run executes."""
    return next((a for a in run.args if isinstance(a, ServerGoalHandle)), None)


class ActionCallbacks(NamedTuple):
    """Callbacks of an action server."""

    execute: Callable[..., object]
    handle_accepted: Callable[..., object]


def callbacks_of(server: ActionServer) -> ActionCallbacks:
    """Return callbacks of an action server, which rclpy's private names hold: programs may assign them."""
    return ActionCallbacks(server._execute_callback, server._handle_accepted_callback)


def node_of_goal(goal: ServerGoalHandle) -> Node:
    """Return the node whose action server has a goal."""
    return internals_of(goal.action_server).node


def served(run: Run) -> str:
    """Return the call or goal that a run answers."""
    goal = goal_of(run)
    if goal is not None:
        return goal_id(bytes(goal.goal_id.uuid))
    work = run.work
    found = next((a for a in work.args if isinstance(a, Asked)), None) if isinstance(work, partial) else None
    return "" if found is None else found.call


def frames_of(run: Run) -> list[Frame]:
    """Return the frames of a suspended run, outermost first."""
    return [frame for frame in map(suspended, awaited(run.coroutine)) if frame is not None]
