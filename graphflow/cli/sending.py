"""What `action send_goal` does once it has a goal."""

from __future__ import annotations

import asyncio
from asyncio import CancelledError
from textwrap import indent
from typing import Any

from graphflow.cli import exits, output
from graphflow.cli.visiting import visit
from graphflow.errors import GoalAborted, GoalCanceled, GoalLost, GoalRejected, ServiceUnavailable
from graphflow.introspect.echo import block, plain
from graphflow.msgs.base import Message
from graphflow.runtime.action_client import ClientGoalHandle
from graphflow.runtime.node import Node

STRAGGLERS = 0.1
"""Seconds in which feedback may still arrive after the goal has ended."""


def send(name: str, type_: Any, goal: Message, *, show_feedback: bool, timeout: float) -> int:
    """Send a goal and follow it to its end; returns the exit code."""

    async def work(node: Node) -> int:
        client = node.create_action_client(type_, name)
        output.data("Waiting for an action server to become available...")
        try:
            await client.expect_ready(timeout)
        except ServiceUnavailable as error:
            output.error(str(error))
            return exits.TIMEOUT
        output.data(f"Sending goal:\n{_shown(goal)}")
        try:
            return await _follow(client.send(goal, timeout=timeout), show_feedback)
        except GoalRejected as error:
            output.data("Goal was rejected.")
            output.talk(str(error))
            return exits.FAILED

    return visit(work)


async def _follow(sending: Any, show_feedback: bool) -> int:
    sent: ClientGoalHandle[Any, Any, Any] | None = None
    try:
        async with sending as sent:
            assert sent is not None
            output.data(f"Goal accepted with ID: {sent.goal_id.hex()}\n")
            try:
                if show_feedback:
                    await _show_feedback(sent)
                    # The result takes another path through the network than feedback and may overtake the last of it.
                    await asyncio.sleep(STRAGGLERS)
                    await _show_feedback(sent)
                return await _result(sent)
            except CancelledError:
                output.data("Canceling goal...")
                raise
    except CancelledError:
        if sent is not None:
            is_canceled = sent.status.name == "CANCELED"
            output.data("Goal canceled." if is_canceled else f"Goal is {sent.status.name}.")
            return exits.OK if is_canceled else exits.FAILED
        output.data("Goal withdrawn before it was accepted.")
        raise


async def _show_feedback(sent: ClientGoalHandle[Any, Any, Any]) -> None:
    async for feedback in sent.feedback():
        output.data(f"Feedback:\n{_shown(feedback)}")


async def _result(sent: ClientGoalHandle[Any, Any, Any]) -> int:
    code = exits.FAILED
    try:
        result = await sent.result()
        code = exits.OK
    except (GoalAborted, GoalCanceled) as error:
        output.talk(str(error))
        result = error.result
    except GoalLost as error:
        output.error(str(error))
        return exits.FAILED
    output.data(f"Result:\n{_shown(result)}")
    output.data(f"Goal finished with status: {sent.status.name}")
    return code


def _shown(message: Any) -> str:
    return indent(block(plain(message)).rstrip("\n"), "    ") + "\n"
