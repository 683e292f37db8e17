"""The block of a goal that is sent: `async with client.send(goal) as sent`."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from graphflow.runtime.mistakes.unentered import Unentered


class _Handle(Protocol):
    @property
    def done(self) -> bool: ...


H = TypeVar("H", bound=_Handle)


class _Host(Protocol):
    @property
    def log(self) -> logging.Logger: ...


class _Client(Protocol[H]):
    """An action client, as the block sees it."""

    @property
    def host(self) -> _Host: ...

    async def send_goal(self, goal: Any, *, timeout: float | None) -> H: ...

    async def leave(self, goal: H) -> None: ...


class Sending(Unentered[H]):
    """The context manager that `GoalClient.send` returns: a goal for the length of a block."""

    def __init__(self, client: _Client[H], goal: object, timeout: float | None, *, detach: bool) -> None:
        way = "`async with client.send(goal) as sent:`, or `sent = await client.send_goal(goal)`"
        super().__init__(f"{way}, then `await sent.result()`")
        self._client, self._goal, self._timeout, self._detach = client, goal, timeout, detach
        self._sent: H | None = None

    async def __aenter__(self) -> H:
        self._is_known = True
        self._sent = await self._client.send_goal(self._goal, timeout=self._timeout)
        return self._sent

    async def __aexit__(self, kind: type[BaseException] | None, *_: object) -> None:
        assert self._sent is not None
        if not self._detach and not self._sent.done:
            if kind is None:
                from graphflow.runtime.mistakes.left_early import left_early  # most programs never need it

                if text := left_early(self._place):
                    self._client.host.log.warning("%s", text)
            await self._client.leave(self._sent)

    if not TYPE_CHECKING:  # type checkers must keep reporting unknown attributes

        def __getattr__(self, name: str) -> object:
            """Raise AttributeError: the goal has not been sent yet."""
            self._is_known = True
            from graphflow.runtime.mistakes.unsent import sending_line  # most programs never need it

            text = f"the goal is not sent yet, and has no {name!r}: {sending_line(self._place)}"
            raise AttributeError(text, name=name, obj=self)
