"""The work of `topic echo`: subscribe to a topic of a known type and print its messages."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from graphflow.cli import exits, output
from graphflow.cli.messages.conditions import compile_condition
from graphflow.cli.messages.echo_options import EchoOptions
from graphflow.cli.temporary_node import run_with_node
from graphflow.errors import GraphflowError
from graphflow.introspect.empty_hint import why_silent
from graphflow.introspect.messages.echo import block, csv, flow, plain, truncated
from graphflow.introspect.messages.fields import Path, field_path, value_at
from graphflow.msgs import registry
from graphflow.qos import Qos
from graphflow.runtime.endpoints import raw
from graphflow.runtime.endpoints.events import QosEvent
from graphflow.runtime.endpoints.subscriptions import TopicSubscription
from graphflow.runtime.node import Node
from graphflow.wire.attachment import MessageInfo
from graphflow.wire.gid import gid_text
from graphflow.wire.liveliness import Kind

_EVENTS = {0: "REQUEST_SENT", 1: "REQUEST_RECEIVED", 2: "RESPONSE_SENT", 3: "RESPONSE_RECEIVED"}
"""Events of a service with introspection: service_msgs/msg/ServiceEventInfo."""
SILENT = 5.0
"""Seconds without a first message after which the reason is reported, if it is known."""
DISCOVERY = 0.2
"""Seconds to wait for the topic's publishers to be discovered."""


def run(topic: str, type_name: str, options: EchoOptions) -> int:
    """Print messages until done or stopped; return the exit code."""
    path = field_path(options.field, type_name) if options.field else []
    wanted = compile_condition(options.condition) if options.condition else None

    async def work(node: Node) -> int:
        return await _echo(node, topic, type_name, options, path, wanted)

    return run_with_node(work, options.node_name)


async def _echo(
    node: Node,
    topic: str,
    type_name: str,
    options: EchoOptions,
    path: Path,
    wanted: Callable[[object], bool] | None,
) -> int:
    await _discover(node, topic)
    on_event = None if options.no_lost_messages else _report_loss
    subscription: _Raw | TopicSubscription[Any]
    if options.raw:
        subscription = _Raw(node, type_name, topic, options.qos, wanted)
        wanted = None
    else:
        type_: Any = registry.interface_class(type_name)
        subscription = node.create_subscription(type_, topic, None, options.qos, on_event=on_event)
    warned = asyncio.ensure_future(_warn_of_silence(node, topic))
    try:
        async with node.clock.timeout(options.timeout or float(10**9)):
            message, info = await subscription.next_with_info()
    except TimeoutError:
        output.error(f"no message on {topic} within {options.timeout:g} s")
        return exits.TIMEOUT
    finally:
        warned.cancel()
    while True:
        if wanted is None or wanted(message):
            if options.clear:
                output.clear()
            output.data(render(message, info, options, path))
            if options.once:
                return exits.OK
        message, info = await subscription.next_with_info()


class _Raw:
    """A subscription to undecoded messages, of which at most `qos.depth` are queued; further ones are dropped.

    Args:
        wanted: Filter of messages; None for all.
    """

    def __init__(
        self, node: Node, type_name: str, topic: str, qos: Qos, wanted: Callable[[object], bool] | None
    ) -> None:
        self._queue: asyncio.Queue[tuple[bytes, MessageInfo]] = asyncio.Queue(qos.depth)
        self._decode = None if wanted is None else registry.codec(type_name).decode
        self._wanted = wanted
        raw.subscribe(node, type_name, topic, self._arrived, qos)

    def _arrived(self, payload: bytes, info: MessageInfo) -> None:
        if not self._queue.full():
            self._queue.put_nowait((payload, info))

    async def next_with_info(self) -> tuple[bytes, MessageInfo]:
        while True:
            payload, info = await self._queue.get()
            if self._wanted is None or self._decode is None or self._wanted(self._decode(payload)):
                return payload, info


async def _warn_of_silence(node: Node, topic: str) -> None:
    await node.clock.sleep(SILENT)
    with suppress(GraphflowError):  # the router may have gone; then there is nothing to explain
        if text := await node.offload(why_silent, [topic]):
            output.talk(f"WARNING: {text}")


def _report_loss(event: QosEvent) -> None:
    if event.kind == "message_lost":
        output.talk(f"A message was lost!!!\n\ttotal count change:{event.change}\n\ttotal count: {event.total}---")


async def _discover(node: Node, topic: str) -> None:
    """Wait a moment for the topic's publishers to be discovered, since their QoS determines ours."""
    try:
        async with node.clock.timeout(DISCOVERY):
            await node.context.wait_for(lambda: bool(node.context.cache.endpoints(Kind.PUBLISHER, topic)))
    except TimeoutError:
        return


def render(message: Any, info: MessageInfo, options: EchoOptions, path: Path) -> str:
    """Format one message as text."""
    if options.raw:
        return f"{message!r}\n---"
    try:
        is_whole = options.as_json or options.full_length or options.no_arr
        data = plain(value_at(message, path), None if is_whole else options.truncate_length)
    except IndexError:
        return f"# this message has no element {options.field}\n---"
    if not path and type(message).SCHEMA.name.endswith("_Event") and "info" in data:
        data["info"]["event_type"] = _EVENTS.get(data["info"]["event_type"], data["info"]["event_type"])
    if options.as_json:
        import json

        return json.dumps(data)
    data = _reduced(data, options)
    if options.csv:
        return csv(data)
    head = ""
    if options.include_message_info:
        head = f"# sequence {info.sequence}, sent {info.source_ns / 1e9:.9f}, by {gid_text(info.gid)}\n"
    if options.flow_style and isinstance(data, dict):
        text = "\n".join(f"{k}: {flow(v)}" for k, v in data.items())
    else:
        text = block(data)
    return f"{head}{text}\n---"


def _reduced(data: Any, options: EchoOptions) -> Any:
    if isinstance(data, dict):
        return {k: _reduced(v, options) for k, v in data.items()}
    if isinstance(data, list) and options.no_arr:
        return f"<array of {len(data)}>"
    if isinstance(data, str) and options.no_str:
        return f"<string of {len(data)}>"
    return truncated(data, None if options.full_length else options.truncate_length)
