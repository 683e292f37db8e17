"""Keeping the rendezvous alive: when its process dies, those that are left bind its port at once."""

from __future__ import annotations

import asyncio
import logging
import random
from collections.abc import Callable

from graphflow.transport.config import rendezvous_endpoint
from graphflow.transport.rendezvous import Router, host, occupied
from graphflow.transport.zenoh import ZenohSession

logger = logging.getLogger("graphflow.rendezvous")

_JITTER = 0.05
_RETRY = 0.5


class Takeover:
    """This process's part in keeping a rendezvous on the machine.

    Args:
        router: The rendezvous, if this process is it already.
    """

    def __init__(self, router: Router | None) -> None:
        self._router = router
        self._retry: asyncio.TimerHandle | None = None
        self._attempt: asyncio.Future[Router | None] | None = None
        self._stop_watching: Callable[[], None] | None = None
        self._warned = False

    @property
    def is_host(self) -> bool:
        """Whether this process is the rendezvous."""
        return self._router is not None

    def guard(self, session: ZenohSession, loop: asyncio.AbstractEventLoop) -> None:
        """From now on, take over when the rendezvous that `session` is connected to dies."""

        def lost(_: str) -> None:
            if self._router is None and self._retry is None and not session.routers():
                # The jitter keeps all the survivors from binding in the same instant.
                self._retry = loop.call_later(random.uniform(0, _JITTER), attempt)  # noqa: S311

        def attempt() -> None:
            self._retry = None
            if self._router is None and not session.routers():
                self._attempt = loop.run_in_executor(None, host)
                self._attempt.add_done_callback(attempted)

        def attempted(future: asyncio.Future[Router | None]) -> None:
            self._attempt = None
            if future.cancelled():
                return
            self._router = future.result()
            if self._router is not None:
                self._warned = False
                logger.debug("took over the rendezvous at %s", rendezvous_endpoint())
            elif not session.routers():
                self._retry = loop.call_later(_RETRY, complain)

        def complain() -> None:
            self._retry = None
            if session.routers():
                self._warned = False
                return
            if not self._warned:
                self._warned = True
                logger.warning("%s", occupied(rendezvous_endpoint(), "keeps newcomers from finding this process"))
            attempt()

        watcher = session.watch_transports(lost)
        self._stop_watching = watcher.close

    async def close(self) -> None:
        """Stop guarding, and stop being the rendezvous."""
        if self._stop_watching is not None:
            self._stop_watching()
        if self._retry is not None:
            self._retry.cancel()
        if self._attempt is not None:
            self._router = await self._attempt
        if self._router is not None:
            await asyncio.to_thread(self._router.close)
            self._router = None
