"""Takeover of the rendezvous: when its process dies, the remaining ones try to bind its port at once."""

from __future__ import annotations

import asyncio
import logging
import random

from graphflow.domain import rendezvous_endpoint
from graphflow.transport.base import Closable
from graphflow.transport.event_loop.loop import in_thread
from graphflow.transport.rendezvous import Router, host, occupied
from graphflow.transport.zenoh import ZenohSession

logger = logging.getLogger("graphflow.rendezvous")

_JITTER = 0.05
_RETRY = 0.5
_PATIENCE = 5
"""Failed attempts before a warning: short-lived commands may host the rendezvous in turn."""


class Takeover:
    """This process's part in keeping a rendezvous on the machine.

    Args:
        router: The rendezvous, if this process already hosts it.
    """

    def __init__(self, router: Router | None) -> None:
        self._router = router
        self._session: ZenohSession | None = None
        self._loop = asyncio.get_running_loop()
        self._alarm: asyncio.TimerHandle | None = None
        self._attempt: asyncio.Future[Router | None] | None = None
        self._watcher: Closable | None = None
        self._gone: set[str] = set()
        """Sessions whose connection has ended, which Zenoh reports before it updates its list of routers."""
        self._failures = 0
        """Successive failed attempts."""
        self._closed = False

    def guard(self, session: ZenohSession) -> None:
        """Take over from now on when the rendezvous of `session` dies or is already dead."""
        self._session = session
        self._watcher = session.watch_transports(self._changed)
        self._look()

    @property
    def is_router(self) -> bool:
        """Whether this process hosts the rendezvous."""
        return self._router is not None

    @property
    def router_id(self) -> str:
        """The rendezvous's Zenoh id; "" while there is none."""
        return next(iter(self._session.routers()), "") if self._session is not None else ""

    def _is_needed(self) -> bool:
        if self._closed or self._router is not None or self._session is None:
            return False
        routers = set(self._session.routers())
        self._gone &= routers
        return not routers - self._gone

    def _changed(self, zid: str, alive: bool) -> None:
        """Handle the start or end of a connection to another session."""
        if alive:
            self._gone.discard(zid)
        else:
            self._gone.add(zid)
            self._look()

    def _look(self) -> None:
        if self._alarm is None and self._attempt is None and self._is_needed():
            # The jitter keeps the survivors from all binding at the same instant.
            self._alarm = self._loop.call_later(random.uniform(0, _JITTER), self._try)  # noqa: S311

    def _try(self) -> None:
        self._alarm = None
        if self._is_needed():
            self._attempt = self._loop.run_in_executor(None, host)
            self._attempt.add_done_callback(self._tried)

    def _tried(self, attempt: asyncio.Future[Router | None]) -> None:
        self._attempt = None
        if attempt.cancelled():
            return
        self._router = attempt.result()
        if self._router is not None:
            self._failures = 0
            logger.debug("took over the rendezvous at %s", rendezvous_endpoint())
        elif self._is_needed():
            self._alarm = self._loop.call_later(_RETRY, self._try_again)

    def _try_again(self) -> None:
        self._failures = self._failures + 1 if self._is_needed() else 0
        if self._failures == _PATIENCE:
            logger.warning("%s", occupied(rendezvous_endpoint(), "keeps newcomers from finding this process"))
        self._try()

    async def close(self) -> None:
        """Stop guarding, and stop hosting the rendezvous."""
        self._closed = True
        if self._watcher is not None:
            self._watcher.close()
        if self._alarm is not None:
            self._alarm.cancel()
        if self._attempt is not None:
            # Not abandoned: if it succeeds after all, the router would go on without an owner.
            self._router = await self._attempt
        if self._router is not None:
            await in_thread(self._router.close)
            self._router = None
