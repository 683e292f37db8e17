"""Reasons for rejected and aborted goals, which ROS 2's messages cannot carry, on a query key unknown to ROS 2.

    @graphflow/<domain>/goals/<server's zid>      a goal's id -> the reason, as text

A client queries the key after its goal was rejected or aborted; servers other than graphflow's do not answer.
"""

from __future__ import annotations

import asyncio
from collections import OrderedDict

from graphflow.errors import printable
from graphflow.transport.base import Answer, Closable, Session
from graphflow.transport.inbox import Inbox
from graphflow.wire import attachment
from graphflow.wire.process import GOALS, answer_key

KEPT = 1_000
"""Reasons kept."""
LONGEST = 1_000
"""Longest reason sent, in characters."""
PATIENCE = 0.5
"""Seconds to wait for a server's reason."""
AT_ONCE = 64
"""Queries answered per iteration of the event loop."""
_ID_SIZE = 16
"""Bytes in a goal's id."""


class Reasons:
    """The reasons of one process's action servers, and queries for those of other processes."""

    def __init__(self, session: Session, domain: int) -> None:
        self._session, self._domain = session, domain
        self._by_goal: OrderedDict[bytes, str] = OrderedDict()
        self._inbox = Inbox(session.bell, KEPT, self._asked)
        self._server: Closable | None = None

    def open(self) -> None:
        """Start answering queries."""
        if self._server is None:
            key = answer_key(self._domain, GOALS, self._session.zid)
            self._server = self._session.open_server(key, self._inbox, is_paced=True)

    def note(self, goal_id: bytes, reason: str) -> None:
        """Store the reason why a goal was rejected or aborted."""
        self._by_goal[goal_id] = reason[:LONGEST]
        while len(self._by_goal) > KEPT:
            self._by_goal.popitem(last=False)

    def _asked(self) -> None:
        for _ in range(min(AT_ONCE, len(self._inbox.items))):
            request = self._inbox.items.popleft()
            goal_id = bytes(request.payload[:_ID_SIZE])
            request.reply(self._by_goal.get(goal_id, "").encode(), attachment.pack(0, 0, bytes(_ID_SIZE)))
        if self._inbox.items:  # a client that queries without pause must not monopolize the loop
            asyncio.get_running_loop().call_soon(self._asked)

    async def ask(self, zid: str, goal_id: bytes) -> str:
        """Query another process for a goal's reason; returns "" if it has none."""
        if zid == self._session.zid:
            return self._by_goal.get(goal_id, "")
        replied: asyncio.Future[Answer | None] = asyncio.get_running_loop().create_future()

        def answered(answer: Answer | None) -> None:
            if not replied.done():
                replied.set_result(answer)

        caller = self._session.open_caller(answer_key(self._domain, GOALS, zid), lambda: None)
        try:
            give_up = caller.call(goal_id, attachment.pack(0, 0, bytes(_ID_SIZE)), answered)
            try:
                async with asyncio.timeout(PATIENCE):
                    answer = await replied
            except TimeoutError:
                give_up()
                return ""
        finally:
            caller.close()
        if answer is None or answer.is_error:
            return ""
        return printable(bytes(answer.payload)[: 4 * LONGEST].decode(errors="replace")[:LONGEST])

    def close(self) -> None:
        """Stop answering queries."""
        if self._server is not None:
            self._server.close()
