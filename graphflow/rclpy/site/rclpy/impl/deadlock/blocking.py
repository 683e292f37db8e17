"""The object that a blocked callback or thread waits for: an answer, a future, an event, or a lock."""

from __future__ import annotations

import ast
import concurrent.futures.thread
import sys
import threading
from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

from graphflow.analysis.class_source import Unknown
from graphflow.analysis.frames import Frame, stack_from
from graphflow.analysis.syntax import nodes_in
from graphflow.analysis.user_code import is_users
from rclpy.action.client import ActionClient
from rclpy.client import Client
from rclpy.executors import Executor
from rclpy.impl.action_internals import ActionClientInternals
from rclpy.impl.deadlock.buffers import BufferWait, buffer_wait
from rclpy.impl.deadlock.later_servers import tries_forever
from rclpy.impl.deadlock.locks import Entering, entered_at, function_of
from rclpy.impl.deadlock.stacks import Level
from rclpy.impl.entities import clients_of
from rclpy.task import Future
from rclpy.timer import Rate, Timer

_FUTURES = (
    Client.call.__code__,
    ActionClientInternals.block_on.__code__,
    Executor.spin_until_future_complete.__code__,
)
"""Functions that block on a future in their variable `future`."""
_SLEEP = Rate.sleep.__code__
_OPENINGS = (Client.wait_for_service.__code__, ActionClient.wait_for_server.__code__)
_SEARCHED = (*_FUTURES, _SLEEP, *_OPENINGS)

_JOIN = threading.Thread.join.__code__
_RESULT = concurrent.futures.Future.result.__code__
_POOL = concurrent.futures.thread.__file__


class Blocked(NamedTuple):
    """The object of a wait: one of these fields, or nothing known."""

    future: Future | None = None
    timer: Timer | None = None
    lock: Entering | None = None
    thread: int | None = None
    """The identity of an awaited thread: for its end, or for its work in a pool."""
    buffer: BufferWait | None = None
    service: str = ""
    """The full name of an awaited service; for an action, that of one of its services."""
    timeout: float | None = None
    """The time limit of the wait in seconds, from its start."""


def blocked(level: Level) -> Blocked:
    """Determine what a thread's code waits for."""
    for caller, frame in reversed([*pairwise([None, *level.frames])]):
        assert frame is not None
        if frame.f_code in _SEARCHED:
            names = frame.f_locals
            timeout = names.get("timeout_sec")
            limit = timeout if isinstance(timeout, (int, float)) and timeout >= 0 else None
            if frame.f_code is _SLEEP:
                return Blocked(timer=names["self"].timer)
            if frame.f_code in _OPENINGS:
                return Blocked(service=_service_of(names["self"]), timeout=limit)
            if names.get("future") is not None:
                return Blocked(future=names["future"], timeout=limit)
        if (wait := buffer_wait(frame, caller)) is not None:
            return Blocked(buffer=wait, timeout=wait.timeout)
        if frame.f_code in (_JOIN, _RESULT):
            names = frame.f_locals
            thread = names["self"].ident if frame.f_code is _JOIN else _worker_of(names["self"])
            return Blocked(thread=thread, timeout=names.get("timeout"))
    users = level.innermost
    if users is None:
        return Blocked()
    if (client := _polled_client(users)) is not None:
        return Blocked(service=_service_of(client))
    return Blocked(future=_polled(users), lock=entered_at(users) if users is level.frames[-1] else None)


def _service_of(client: Client | ActionClient) -> str:
    return clients_of(client)[0].name


def is_private(level: Level) -> bool:
    """Whether only rclpy knows the awaited future: that of a blocking call."""
    codes = {frame.f_code for frame in level.frames}
    return not codes.isdisjoint((Client.call.__code__, ActionClient.send_goal.__code__))


def limit_of(level: Level) -> float | None:
    """Return the time limit in seconds of a wait for an event, a queue or similar; None if unlimited."""
    for frame in reversed(level.frames):
        if is_users(frame.f_code.co_filename):
            break
        timeout = frame.f_locals.get("timeout")
        if isinstance(timeout, (int, float)):
            return timeout
    return None


def _worker_of(future: concurrent.futures.Future[Any]) -> int | None:
    """Return the pool thread that works for a future."""
    for thread, innermost in sys._current_frames().items():
        for frame in stack_from(innermost):
            if frame.f_code.co_filename == _POOL and getattr(frame.f_locals.get("self"), "future", None) is future:
                return thread
    return None


# a loop that polls a future


def _polled(frame: Frame) -> Future | None:
    """Return the future that the innermost loop around a line polls, if nothing else ends the loop."""
    loop = _loop_around(frame)
    if loop is None:
        return None
    asked = [*_polled_object(loop.test)]
    if asked:
        return _future(asked[0], frame) if len(asked) == 1 and _is_only_exit(loop) else None
    if not (isinstance(loop.test, ast.Constant) or ast.unparse(loop.test) in ("rclpy.ok()", "ok()")):
        return None
    choices = [n for n in loop.body if isinstance(n, ast.If) and [*_polled_object(n.test)]]
    if (
        len(choices) != 1
        or isinstance(choices[0].test, ast.BoolOp)
        or _leaves([n for n in loop.body if n is not choices[0]])
    ):
        return None
    return _future(next(_polled_object(choices[0].test)), frame)


def _loop_around(frame: Frame) -> ast.While | None:
    """Return the innermost loop around a line."""
    try:
        function = function_of(frame)
    except Unknown:
        return None
    loops = [n for n in nodes_in(function) if isinstance(n, ast.While) and _spans(n, frame.f_lineno)]
    return loops[-1] if loops else None


def _polled_object(test: ast.expr) -> Iterator[ast.expr]:
    """Return the object whose `done()` a condition calls."""
    for node in nodes_in(test):
        match node:
            case ast.Call(func=ast.Attribute(value=owner, attr="done"), args=[]):
                yield owner
            case ast.Compare(
                left=ast.Call(func=ast.Attribute(value=owner, attr="result"), args=[]),
                ops=[ast.Is() | ast.IsNot()],
                comparators=[ast.Constant(value=None)],
            ):
                yield owner


def _is_only_exit(loop: ast.While) -> bool:
    """Whether only the polled answer, or the end of the program, ends a loop: no clock and no counter."""
    is_both = isinstance(loop.test, ast.BoolOp) and isinstance(loop.test.op, ast.And)
    parts = loop.test.values if is_both else [loop.test]  # type: ignore[attr-defined]
    others = [part for part in parts if not ast.unparse(part).endswith("ok()") and not [*_polled_object(part)]]
    nested = [node for part in parts for node in nodes_in(part) if isinstance(node, ast.BoolOp)]
    return not (others or nested or _leaves(loop.body))


def _leaves(body: list[ast.stmt]) -> bool:
    """Whether statements may leave their loop."""
    return any(isinstance(n, (ast.Break, ast.Return, ast.Raise)) for statement in body for n in nodes_in(statement))


def _future(expression: ast.expr, frame: Frame) -> Future | None:
    found = _value(expression, frame)
    return found if isinstance(found, Future) else None


def _value(expression: ast.expr, frame: Frame) -> object:
    """Return the value of a name, or of an attribute of one; None if unknown."""
    match expression:
        case ast.Name(id=name):
            return frame.f_locals.get(name, frame.f_globals.get(name))
        case ast.Attribute(value=ast.Name(id=owner), attr=name):
            return getattr(frame.f_locals.get(owner), "__dict__", {}).get(name)
    return None


def _polled_client(frame: Frame) -> Client | ActionClient | None:
    """Return the client whose server the innermost loop around a line waits for."""
    loop = _loop_around(frame)
    for node in nodes_in(loop.test) if loop is not None and tries_forever(frame) else ():
        match node:
            case ast.Call(func=ast.Attribute(value=owner, attr="service_is_ready" | "server_is_ready")):
                found = _value(owner, frame)
                return found if isinstance(found, (Client, ActionClient)) else None
    return None


def _spans(node: ast.stmt, line: int) -> bool:
    return node.lineno <= line <= (node.end_lineno or line)
