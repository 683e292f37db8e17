"""Configuration, opening and closing of Zenoh sessions. Free of asyncio, so that short commands start quickly."""

from __future__ import annotations

import atexit
import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache

import zenoh

from graphflow.errors import TransportError
from graphflow.transport.event_loop.daemon_threads import THREADS

logger = logging.getLogger("graphflow")
CONNECT_VARIABLE = "GRAPHFLOW_CONNECT"
"""Endpoints of routers on other machines, separated by spaces."""
PROFILE_VARIABLE = "GRAPHFLOW_NET"
"""The path of a net profile (`graph.net`)."""

# Undeclaring a publisher that keeps messages holds the GIL until a task of Zenoh's has ended. That takes 10 s if all
# threads for such tasks wait for the GIL in callbacks, of which there may be three for each action client when its
# server leaves. A thread costs next to nothing. Read when the first session is opened.
os.environ.setdefault("ZENOH_RUNTIME", "(net: (worker_threads: 8))")

CLOSE_LIMIT = 2.0
"""Seconds for a session to close."""
CALLBACK_LIMIT = 1.0
"""Seconds for Zenoh's callback threads to end at exit, once their sessions are closed."""
ANSWERING = "graphflow-questions"
"""Name of threads that wait for queries, which end with the session."""
OPEN_LIMIT = 10.0
"""Seconds for two sessions to connect. Peers that discover each other try once: on a busy machine with twenty of them
starting, a short limit would prevent a connection for good."""
LEASE_HERE = 120.0
"""Lease in seconds between processes of this machine, where the system reports a process's end and closes its sockets
at once. Only a stopped process is silent; it leaves the graph after this time."""
QUERY_LIMIT_MS = 600_000
"""Query timeout as in rmw_zenoh; graphflow's own deadlines are shorter and enforced by the runtime."""

_CONFIG = """{
  mode: "%(mode)s",
  connect: {
    endpoints: [%(connect)s],
    // Zenoh's first retry comes after a second by default, and a rendezvous is often just starting.
    retry: { period_init_ms: 20, period_max_ms: 200, period_increase_factor: 2 },
  },
  listen: { endpoints: [%(listen)s] },
  // Without a delay of 0 opening takes half a second, even with multicast off.
  scouting: {
    delay: 0,
    multicast: { enabled: false },
    gossip: {
      enabled: true,
      // One of two peers dials the other: otherwise both do, and keep both connections.
      autoconnect_strategy: { peer: { to_router: "always", to_peer: "greater-zid" } },
      // The rendezvous tells every peer about every other; peers need not repeat it.
      target: { router: ["router", "peer"], peer: ["router"] },
    },
  },
  // Advanced publishers, which keep messages for late joiners, order them by time stamp.
  timestamping: { enabled: true },
  queries_default_timeout: %(query_limit)d,
  adminspace: { enabled: false },
  transport: {
    unicast: { open_timeout: %(open_limit)d, accept_timeout: 10000 },
    // Two keep-alives per lease, as in rmw_zenoh.
    link: { tx: { lease: %(lease)d, keep_alive: 2 } },
    // Ours is faster (`ring`), and Zenoh's wakes each idle process 18 times a second. ROS 2 has it off, too.
    shared_memory: { enabled: false },
  },
}"""


def reaches_out() -> bool:
    """Whether the environment requests a link to other machines (`transport.link`)."""
    return bool(os.environ.get(CONNECT_VARIABLE) or os.environ.get(PROFILE_VARIABLE))


def config(
    mode: str,
    *,
    connect: Sequence[str] = (),
    listen: str | None = None,
    open_limit: float = OPEN_LIMIT,
    lease: float = LEASE_HERE,
) -> zenoh.Config:
    """Return a session configuration. Multicast is off, and the session listens only on `listen`.

    Args:
        lease: Seconds of silence after which the other side considers this one dead.
    """
    return zenoh.Config.from_json5(
        _CONFIG
        % {
            "mode": mode,
            "connect": ", ".join(f'"{endpoint}"' for endpoint in connect),
            "listen": f'"{listen}"' if listen else "",
            "query_limit": QUERY_LIMIT_MS,
            "open_limit": round(open_limit * 1000),
            "lease": round(lease * 1000),
        }
    )


@cache
def _quiet() -> None:
    """Limit Zenoh's own log to the level in RUST_LOG."""
    zenoh.init_log_from_env_or("off")


def open_session(settings: zenoh.Config) -> zenoh.Session:
    """Open a raw session.

    Raises:
        TransportError: Zenoh failed, or Python runs without its global interpreter lock.
    """
    _quiet()
    if not getattr(sys, "_is_gil_enabled", lambda: True)():
        raise TransportError(
            "this Python runs without its global interpreter lock, by which graphflow reads what waits: "
            "unset PYTHON_GIL, or set it to 1"
        )
    try:
        with _at_work():
            return zenoh.open(settings)
    except zenoh.ZError as error:
        # Zenoh appends the place in its own source: ` at /root/.cargo/...`.
        raise TransportError(str(error).partition(" at /")[0]) from None


def close_session(session: zenoh.Session) -> bool:
    """Close a session; returns False after `CLOSE_LIMIT` seconds, since a stuck peer can block it."""
    ended = threading.Event()
    errors: list[BaseException] = []

    def done(_: None, error: BaseException | None) -> None:
        errors.extend([error] if error is not None else [])
        ended.set()

    def close() -> None:
        with _at_work():
            session.close()  # type: ignore[no-untyped-call]

    THREADS.run(close, done, "graphflow-close")
    is_closed = ended.wait(CLOSE_LIMIT)
    if session in _to_close:
        _to_close.remove(session)
    if errors:
        logger.debug("closing a session: %s", errors[0])
    return is_closed


_works: list[threading.Event] = []
"""Sessions being opened or closed; each event is set at the end."""


@contextmanager
def _at_work() -> Iterator[None]:
    """Delay the interpreter's exit while a session is opened or closed."""
    over = threading.Event()
    _works.append(over)
    try:
        yield
    finally:
        _works.remove(over)
        over.set()


_to_close: list[zenoh.Session] = []
_before_closing: list[Callable[[], None]] = []
_closer: threading.Thread | None = None
_closing = threading.Lock()
"""Locked while sessions are closed at exit."""


def close_at_exit(session: zenoh.Session) -> None:
    """Close `session` when the program's non-daemon threads have ended, unless it has been closed by then.

    Zenoh's callback threads keep the interpreter alive, and `atexit` functions run only after it has waited for them.
    So a thread waits for the main thread, which ends as soon as the interpreter starts to exit, and for the other
    threads that the interpreter waits for.
    """
    _wait_for_main()
    _to_close.append(session)


def before_closing_at_exit(what: Callable[[], None]) -> None:
    """Call `what`, which must not raise, when the program's threads have ended and before sessions are closed."""
    _wait_for_main()
    _before_closing.append(what)


def _wait_for_main() -> None:
    global _closer
    if _closer is None:
        THREADS.reserve()
        _closer = threading.Thread(target=_close_after_main, name="graphflow-exit", daemon=False)
        _closer.start()
        atexit.register(_close_interrupted)


def _close_interrupted() -> None:
    """Close sessions if Ctrl-C has interrupted the wait for that thread; the interpreter then exits all the same.

    A second Ctrl-C often arrives when the main thread has just ended.
    """
    if _closer is not None and _closer.is_alive():
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # closing takes a few seconds at most
        _close_all()


def _close_after_main() -> None:
    threading.main_thread().join()
    while threads := _programs_threads():
        threads[0].join()
    _close_all()


def _close_all() -> None:
    with _closing:
        _close_one_by_one()


def _close_one_by_one() -> None:
    while _before_closing:
        _before_closing.pop()()
    while _to_close:
        session = _to_close.pop()
        if not session.is_closed() and not close_session(session):
            break  # the exiting process ends the other threads
    # A session counts as closed as soon as another thread starts to close it. That thread must return, too: one in
    # Zenoh's code that requests the GIL after finalization aborts the process, and so does a callback's thread.
    limit = time.monotonic() + CLOSE_LIMIT
    for over in list(_works):
        over.wait(max(limit - time.monotonic(), 0))
    limit = time.monotonic() + CALLBACK_LIMIT
    for thread in callback_threads():
        thread.join(max(limit - time.monotonic(), 0))


def _programs_threads() -> list[threading.Thread]:
    """Return the program's own non-daemon threads, which may still use sessions."""
    not_theirs = {threading.current_thread(), threading.main_thread(), *callback_threads()}
    return [t for t in threading.enumerate() if not t.daemon and t not in not_theirs]


def callback_threads() -> list[threading.Thread]:
    """Return Zenoh's callback threads, one per subscriber or queryable, and those that wait for queries, by name.

    They end soon after their session is closed. Those started from a daemon thread are daemons, which the interpreter
    does not wait for; and a thread that requests the GIL after finalization aborts the process.
    """
    return [t for t in threading.enumerate() if t.name.endswith("(pyo3-closure)") or t.name == ANSWERING]
