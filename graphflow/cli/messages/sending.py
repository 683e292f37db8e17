"""The work of `action send_goal`: send a goal and follow it to its end."""

from __future__ import annotations

import asyncio
import time
from asyncio import CancelledError
from collections import deque
from collections.abc import Iterable
from textwrap import indent
from typing import Any, NamedTuple

from graphflow.cli import exits, output
from graphflow.cli.temporary_node import run_with_node
from graphflow.errors import GoalAborted, GoalCanceled, GoalError, GoalLost, GoalRejected, ServiceUnavailable
from graphflow.introspect import server_logs
from graphflow.introspect.messages.echo import block, plain
from graphflow.machines.cache import ACTION_SEND_GOAL
from graphflow.msgs.base import Message
from graphflow.runtime.actions.goal_handles import ClientGoalHandle
from graphflow.runtime.node import Node
from graphflow.wire.liveliness import Kind

AT_ONCE = 1.0
"""Seconds after a goal was sent in which a server checks the request."""
STRAGGLERS = 0.1
"""Seconds in which feedback may still arrive after the goal has ended."""


class _Reporter(NamedTuple):
    """Output of a goal's progress, as text or as JSON."""

    as_json: bool

    def report(self, text: str, event: str = "", **more: object) -> None:
        """Print the text or, as JSON, the event; a text without an event is left out of JSON."""
        if not self.as_json:
            output.data(text)
        elif event:
            output.as_json({"event": event, **more})


def send(name: str, type_: Any, goal: Message, *, show_feedback: bool, timeout: float, as_json: bool = False) -> int:
    """Send a goal and follow it to its end; return the exit code."""
    reporter = _Reporter(as_json)

    async def work(node: Node) -> int:
        client, logs = node.create_action_client(type_, name), _Logs(node, f"{name}{ACTION_SEND_GOAL}")
        reporter.report("Waiting for an action server to become available...")
        try:
            await client.expect_ready(timeout)
        except ServiceUnavailable as error:
            from graphflow.cli.ros.supervised import with_ended  # most goals find their server

            output.error(with_ended(error, node.context.cache.nodes()))
            return exits.TIMEOUT
        reporter.report(f"Sending goal:\n{_indented(goal)}")
        try:
            return await _follow(client.send(goal, timeout=timeout), show_feedback, reporter, logs)
        except GoalRejected as error:
            reporter.report("Goal was rejected.", "rejected")
            output.talk(str(error))
            await logs.explain(error)
            return exits.FAILED

    return run_with_node(work)


class _Logs:
    """The lines that the servers of an action log from now on."""

    def __init__(self, node: Node, service: str) -> None:
        from graphflow.msgs.rcl_interfaces.msg import Log

        self._node, self._service = node, service
        self._began = time.monotonic()
        self._heard: deque[tuple[float, Log]] = deque(maxlen=server_logs.BOUND)
        node.create_subscription(Log, server_logs.TOPIC, self._hear, 100)

    def _hear(self, log: Any) -> None:
        self._heard.append((time.monotonic(), log))

    async def explain(self, error: GoalError) -> None:
        """Show the warnings and errors that may explain why a goal has failed."""
        await asyncio.sleep(server_logs.PATIENCE)
        self._show((log for _, log in self._heard), str(error).partition(" the goal: ")[2])

    async def tell(self, *, is_empty: bool) -> None:
        """Show those that came when the goal had just been sent; for an empty result, they are the only reason."""
        if is_empty and not self._heard:
            await asyncio.sleep(server_logs.PATIENCE)
        self._show(log for heard, log in self._heard if heard - self._began < AT_ONCE)

    def _show(self, logs: Iterable[Any], known: str = "") -> None:
        servers = {server.node_name for server in self._node.context.cache.endpoints(Kind.SERVICE, self._service)}
        for text in server_logs.lines(logs, servers, known):
            output.talk(text)


async def _follow(sending: Any, show_feedback: bool, reporter: _Reporter, logs: _Logs) -> int:
    sent: ClientGoalHandle[Any, Any, Any] | None = None
    try:
        async with sending as sent:
            assert sent is not None
            reporter.report(f"Goal accepted with ID: {sent.goal_id.hex()}\n", "accepted", goal_id=sent.goal_id.hex())
            try:
                if show_feedback:
                    await _show_feedback(sent, reporter)
                    # The result takes another route than feedback and may overtake the last of it.
                    await asyncio.sleep(STRAGGLERS)
                    await _show_feedback(sent, reporter)
                return await _result(sent, reporter, logs)
            except CancelledError:
                reporter.report("Canceling goal...", "canceling")
                raise
    except CancelledError:
        if sent is not None:
            is_canceled = sent.status.name == "CANCELED"
            reporter.report(
                "Goal canceled." if is_canceled else f"Goal is {sent.status.name}.", "end", status=sent.status.name
            )
            return exits.OK if is_canceled else exits.FAILED
        reporter.report("Goal withdrawn before it was accepted.", "withdrawn")
        raise


async def _show_feedback(sent: ClientGoalHandle[Any, Any, Any], reporter: _Reporter) -> None:
    async for feedback in sent.feedback():
        reporter.report(f"Feedback:\n{_indented(feedback)}", "feedback", feedback=plain(feedback))


async def _result(sent: ClientGoalHandle[Any, Any, Any], reporter: _Reporter, logs: _Logs) -> int:
    code = exits.FAILED
    try:
        result = await sent.result()
        code = exits.OK
        await logs.tell(is_empty=result == type(result)())
    except (GoalAborted, GoalCanceled) as error:
        output.talk(str(error))
        await logs.explain(error)
        result = error.result
    except GoalLost as error:
        output.error(str(error))
        return exits.FAILED
    reporter.report(f"Result:\n{_indented(result)}", "result", result=plain(result))
    reporter.report(f"Goal finished with status: {sent.status.name}", "end", status=sent.status.name)
    return code


def _indented(message: Message) -> str:
    return indent(block(plain(message)).rstrip("\n"), "    ") + "\n"
