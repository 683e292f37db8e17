"""Blocking client sessions for short commands, without asyncio and invisible in the graph."""

from __future__ import annotations

import queue
import re
import time
from collections import Counter, deque
from typing import Any, Self

import zenoh
from zenoh.handlers import Callback

from graphflow.domain import rendezvous_endpoint
from graphflow.errors import SupervisorError, TransportError
from graphflow.transport.base import Answer
from graphflow.transport.config import close_session, reaches_out
from graphflow.transport.rendezvous import join

TOKENS_LIMIT = 10.0
"""Seconds after which queries for tokens stop."""
_ZID = re.compile("[0-9a-f]{16,32}")
"""The id of a session in a token."""
MANY_TOKENS = 1000
"""Number of tokens that a router takes noticeable time to process."""


class Client:
    """A session at the rendezvous or, if nothing runs on this machine, at a router given by `--connect`.

    Raises:
        TransportError: As for `rendezvous.join`.
        SupervisorError: No router answers (exit status 3).
    """

    def __init__(self) -> None:
        session = join() or _dial()
        if session is None:
            raise SupervisorError(f"nothing is running: {_nobody()}", exit_code=3)
        self._session = session

    @property
    def zid(self) -> str:
        return str(self._session.info.zid())

    def tokens(self, key: str) -> list[str]:
        """Return every matching liveliness token, querying the router until it knows all of them.

        Raises:
            TransportError: The tokens were not complete in time.
        """
        # The router does not say when it knows all tokens. A few are known at once; of many, an answer counts as
        # complete if it has no more than the one before.
        began, before = time.monotonic(), MANY_TOKENS
        while True:
            found = self._known(key)
            if time.monotonic() - began >= TOKENS_LIMIT:
                text = f"only {len(found)} tokens of the graph came within {TOKENS_LIMIT:g} s{_most(found)}"
                raise TransportError(f"{text}; try again")
            if len(found) <= before:
                return found
            before = len(found)

    def _known(self, key: str) -> list[str]:
        """Return the tokens that the router knows now."""
        replies = self._session.liveliness().get(key, timeout=TOKENS_LIMIT)
        return [str(r.ok.key_expr) for r in replies if r.ok is not None]

    def reports(self, key: str, timeout: float) -> list[bytes]:
        """Return all replies on matching keys within `timeout` seconds."""
        replies = self._session.get(
            key, target=zenoh.QueryTarget.ALL, consolidation=zenoh.ConsolidationMode.NONE, timeout=timeout
        )
        return [r.ok.payload.to_bytes() for r in replies if r.ok is not None]

    def call(self, key: str, payload: bytes, attachment: bytes, timeout: float) -> Answer | None:
        """Call the servers on a key; returns the first reply, or None when none will come.

        Raises:
            TimeoutError: No reply arrived within `timeout` seconds.
        """
        answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
        # Direct, since Zenoh would start a thread for an indirect callback.
        self._session.get(
            key,
            Callback(answers.put, drop=lambda: answers.put(None), indirect=False),
            payload=payload,
            attachment=attachment,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            # Longer than ours: Zenoh reports its timeout as an error reply, which would look like a server's.
            timeout=timeout + 1.0,
        )
        try:
            reply = answers.get(timeout=timeout)
        except queue.Empty:
            raise TimeoutError from None
        if reply is None:
            return None
        if reply.ok is None:
            return Answer(reply.err.payload.to_bytes(), None, True)
        beside = reply.ok.attachment
        return Answer(reply.ok.payload.to_bytes(), beside.to_bytes() if beside is not None else None, False)

    def hear(self, key: str, bound: int) -> Hearing:
        """Receive what is published on a key from now on.

        Args:
            bound: Number of payloads that are kept, the newest.
        """
        return Hearing(self._session, key, bound)

    def close(self) -> None:
        close_session(self._session)


def _most(tokens: list[str]) -> str:
    """Describe the session that announces most of some tokens; empty if none has many."""
    sessions = Counter(part for token in tokens for part in token.split("/") if _ZID.fullmatch(part))
    [(session, count)] = sessions.most_common(1) or [("", 0)]
    return (
        f", {count} of them from session {session}, which overloads the router: end it" if count > MANY_TOKENS else ""
    )


class Hearing:
    """The payloads that arrive on a key, until it is closed. A context manager."""

    def __init__(self, session: zenoh.Session, key: str, bound: int) -> None:
        self._payloads: deque[bytes] = deque(maxlen=bound)
        # Direct, so that a response cannot overtake what its server has published before.
        heard: Any = Callback(lambda sample: self._payloads.append(sample.payload.to_bytes()), indirect=False)
        self._subscriber: Any = session.declare_subscriber(key, heard)

    def take(self) -> list[bytes]:
        """Return the payloads that have arrived since the last call, the oldest first."""
        # Counted first, since Zenoh's thread appends meanwhile; it may drop some of them, but never leaves fewer.
        return [self._payloads.popleft() for _ in range(len(self._payloads))]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._subscriber.undeclare()


def _nobody() -> str:
    if reaches_out():
        return f"nothing answers at {rendezvous_endpoint()}, nor where --connect or --net points"
    return f"nothing answers at {rendezvous_endpoint()}; start a graph with graphflow up, or a node with graphflow run"


def _dial() -> zenoh.Session | None:
    if not reaches_out():
        return None
    from graphflow.transport.link import dial  # imports the parser of net profiles

    return dial()
