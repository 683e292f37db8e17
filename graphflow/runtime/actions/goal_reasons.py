"""Why goals were rejected or aborted: what ROS 2's messages have no room for, asked on a key that it does not know.

    @graphflow/<domain>/goals/<server's zid>      a goal's id -> the reason, as text

A client asks when it has been told that its goal is rejected or aborted; a server of another kind does not answer.
"""

from __future__ import annotations

import asyncio
from collections import OrderedDict

from graphflow.errors import printable
from graphflow.transport.base import Answer, Closable, Inbox, Session
from graphflow.wire import attachment
from graphflow.wire.process import GOALS, answer_key

KEPT = 1_000
"""Reasons that are remembered."""
LONGEST = 1_000
"""Characters of a reason that are sent."""
PATIENCE = 0.5
"""Seconds that a server has to say why."""
AT_ONCE = 64
"""Questions that are answered before others have a turn of the loop."""
_ID_SIZE = 16
"""Bytes of a goal's id."""


class Reasons:
    """The reasons of one process's action servers, and the way to ask for those of others."""

    def __init__(self, session: Session, domain: int) -> None:
        self._session, self._domain = session, domain
        self._by_goal: OrderedDict[bytes, str] = OrderedDict()
        self._inbox = Inbox(session.bell, KEPT, self._asked)
        self._server: Closable | None = None

    def open(self) -> None:
        """Answer from now on."""
        if self._server is None:
            key = answer_key(self._domain, GOALS, self._session.zid)
            self._server = self._session.open_server(key, self._inbox, is_paced=True)

    def note(self, goal_id: bytes, reason: str) -> None:
        """Remember why a goal did not come to its end."""
        self._by_goal[goal_id] = reason[:LONGEST]
        while len(self._by_goal) > KEPT:
            self._by_goal.popitem(last=False)

    def _asked(self) -> None:
        for _ in range(min(AT_ONCE, len(self._inbox.items))):
            request = self._inbox.items.popleft()
            goal_id = bytes(request.payload[:_ID_SIZE])
            request.reply(self._by_goal.get(goal_id, "").encode(), attachment.pack(0, 0, bytes(_ID_SIZE)))
        if self._inbox.items:  # whoever asks all the time must not hold the loop
            asyncio.get_running_loop().call_soon(self._asked)

    async def ask(self, zid: str, goal_id: bytes) -> str:
        """Why a goal of another process's server did not come to its end; empty if that says nothing."""
        if zid == self._session.zid:
            return self._by_goal.get(goal_id, "")
        told: asyncio.Future[Answer | None] = asyncio.get_running_loop().create_future()

        def answered(answer: Answer | None) -> None:
            if not told.done():
                told.set_result(answer)

        caller = self._session.open_caller(answer_key(self._domain, GOALS, zid), lambda: None)
        try:
            give_up = caller.call(goal_id, attachment.pack(0, 0, bytes(_ID_SIZE)), answered)
            try:
                async with asyncio.timeout(PATIENCE):
                    answer = await told
            except TimeoutError:
                give_up()
                return ""
        finally:
            caller.close()
        if answer is None or answer.is_error:
            return ""
        return printable(bytes(answer.payload)[: 4 * LONGEST].decode(errors="replace")[:LONGEST])

    def close(self) -> None:
        """Answer no more."""
        if self._server is not None:
            self._server.close()
