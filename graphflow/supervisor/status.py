"""The states of a graph's processes as ROS 2 topics and services, read-only.

The hidden node `/<graph>/_supervisor` publishes a diagnostic_msgs/msg/DiagnosticArray on `~/states` after every change,
transient local, and returns the same from `~/get_states`, a diagnostic_msgs/srv/SelfTest.
"""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Literal

from graphflow.qos import Durability, Qos
from graphflow.runtime.context import Context
from graphflow.runtime.node import Node
from graphflow.runtime.node_core import core_of
from graphflow.supervisor.supervisor import Supervisor

if TYPE_CHECKING:
    from graphflow.msgs.diagnostic_msgs.msg import DiagnosticStatus
    from graphflow.msgs.diagnostic_msgs.srv import SelfTest
    from graphflow.supervisor.control.messages import NodeRow

PATIENCE = 1.0
"""Seconds for the nodes of the graph to come up before this one starts."""
SETTLE = 0.05
"""Seconds in which changes are collected into one message."""
_LEVELS = {"ready": 0, "ended": 0, "failed": 2, "given_up": 2, "unresponsive": 3}
"""DiagnosticStatus.level by state; other states are transitions, which count as warnings."""
_Key = Literal["lifecycle", "pid", "process", "class", "restarts", "detail", "last_end"]
_KEYS: tuple[_Key, ...] = ("lifecycle", "pid", "process", "class", "restarts", "detail", "last_end")


class Mirror(Node):
    """A node that publishes the states of a graph's nodes.

    Args:
        graph: The graph's name.
        rows: Returns the graph's nodes, as for `ps`.
    """

    def __init__(self, graph: str, rows: Callable[[], list[NodeRow]]) -> None:
        from graphflow.msgs.diagnostic_msgs.msg import DiagnosticArray
        from graphflow.msgs.diagnostic_msgs.srv import SelfTest

        super().__init__(
            "_supervisor",
            namespace=f"/{_legal(graph)}",
            start_parameter_services=False,
            enable_rosout=False,
            enable_logger_service=False,
        )
        self._graph, self._rows = graph, rows
        latched = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)
        self._states = self.create_publisher(DiagnosticArray, "~/states", latched)
        self.create_service(SelfTest, "~/get_states", self._answer)

    def publish_states(self) -> None:
        from graphflow.msgs.diagnostic_msgs.msg import DiagnosticArray

        message = DiagnosticArray(status=[_status(row) for row in self._rows()])
        now, stamp = self.clock.now(), message.header.stamp
        stamp.sec, stamp.nanosec = now.sec, now.nanosec
        self._states.publish(message)

    def _answer(self, request: SelfTest.Request) -> SelfTest.Response:
        from graphflow.msgs.diagnostic_msgs.srv import SelfTest

        status = [_status(row) for row in self._rows()]
        good = all(one.level == 0 for one in status)
        return SelfTest.Response(id=self._graph, passed=int(good), status=status)


def _legal(graph: str) -> str:
    """Convert a graph's name to a legal namespace."""
    name = re.sub(r"[^A-Za-z0-9]+", "_", graph)
    return f"_{name}" if name[:1].isdigit() else name


def _status(row: NodeRow) -> DiagnosticStatus:
    from graphflow.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue

    return DiagnosticStatus(
        level=_LEVELS.get(row["state"], 1),
        name=row["node"],
        message=row["state"],
        values=[KeyValue(key=key, value=str(row[key])) for key in _KEYS if row[key] not in ("", None)],
    )


async def mirror(supervisor: Supervisor, context: Context) -> None:
    """Publish the states of a graph until cancelled."""
    with suppress(TimeoutError):
        async with asyncio.timeout(PATIENCE):
            await supervisor.up.wait()
    node, changed = Mirror(supervisor.plan.name, supervisor.describe), asyncio.Event()
    await core_of(node).start(context)
    stop = supervisor.clients.subscribe(lambda _: changed.set(), replay=False)
    try:
        while True:
            node.publish_states()
            changed.clear()
            await changed.wait()
            await asyncio.sleep(SETTLE)
    finally:
        stop()
        await core_of(node).stop()
