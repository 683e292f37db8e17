"""How Zenoh sessions are configured, opened and closed. Free of asyncio, for the sake of short commands."""

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

# Undeclaring a publisher that keeps messages holds the GIL until a task of Zenoh's has ended. That takes ten seconds if
# all threads for such tasks wait for the GIL in callbacks, of which there may be three for each action client when its
# server leaves. A thread costs next to nothing. Read when the first session is opened.
os.environ.setdefault("ZENOH_RUNTIME", "(net: (worker_threads: 8))")

CLOSE_LIMIT = 2.0
"""Seconds a session may take to close."""
CALLBACK_LIMIT = 1.0
"""Seconds that Zenoh's callback threads have to end, at exit, when their sessions have been closed."""
ANSWERING = "graphflow-questions"
"""The name of threads that wait for queries: they end with the session."""
OPEN_LIMIT = 10.0
"""Seconds that two sessions may take to connect. Peers that find each other try once: on a busy machine, with twenty of
them starting, an impatient one would never get a connection."""
LEASE_HERE = 120.0
"""Seconds of a lease between processes of this machine: the system tells at once of one that ends, and of its sockets.
Only one that is stopped is silent; it is no longer there when it has been so for as long."""
QUERY_LIMIT_MS = 600_000
"""As in rmw_zenoh; graphflow's own deadlines are shorter and kept by the runtime."""

_CONFIG = """{
  mode: "%(mode)s",
  connect: {
    endpoints: [%(connect)s],
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
    """Whether the environment asks for a link to other machines (`transport.link`)."""
    return bool(os.environ.get(CONNECT_VARIABLE) or os.environ.get(PROFILE_VARIABLE))


def config(
    mode: str,
    *,
    connect: Sequence[str] = (),
    listen: str | None = None,
    open_limit: float = OPEN_LIMIT,
    lease: float = LEASE_HERE,
) -> zenoh.Config:
    """A session configuration. Multicast is off and nothing listens beyond `listen`.

    Args:
        lease: Seconds without a sign of life after which the other side may take this one for dead.
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
    """Limit Zenoh's own log to what RUST_LOG asks for."""
    zenoh.init_log_from_env_or("off")


def open_session(settings: zenoh.Config) -> zenoh.Session:
    """Open a raw session.

    Raises:
        TransportError: Zenoh refused, or Python runs without its global lock.
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
        raise TransportError(str(error).partition(" at /")[0]) from None


def close_session(session: zenoh.Session) -> bool:
    """Close a session, and say whether it is closed; give up after `CLOSE_LIMIT` s, since a stuck peer can hold it."""
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
"""Sessions that are being opened or closed: each is set when that is over."""


@contextmanager
def _at_work() -> Iterator[None]:
    """Open or close a session, which the end of the interpreter waits for."""
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
"""Held while the end of the interpreter closes sessions."""


def close_at_exit(session: zenoh.Session) -> None:
    """Close `session` when the program's threads have ended, daemons aside, if it has not been closed by then.

    Zenoh's callback threads keep the interpreter from ending, and `atexit` comes only after it has waited for them.
    So a thread of our own waits for the main thread, which is done the moment the interpreter begins to end, and for
    the others that the interpreter waits for.
    """
    _wait_for_main()
    _to_close.append(session)


def before_closing_at_exit(what: Callable[[], None]) -> None:
    """Call `what` when the program's threads have ended, before open sessions are closed. It must not raise."""
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
    """Close them where Ctrl-C has broken off the wait for that thread: the interpreter goes on to its end all the same.

    A second one often comes when the main thread has just ended.
    """
    if _closer is not None and _closer.is_alive():
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # it takes some seconds at most
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
            break  # the process that ends takes the others with it
    # A session is closed from the moment at which another thread begins to close it. That must come back, too: one in
    # Zenoh's code that asks for the GIL when the interpreter has gone aborts the process, as a callback's thread does.
    limit = time.monotonic() + CLOSE_LIMIT
    for over in list(_works):
        over.wait(max(limit - time.monotonic(), 0))
    limit = time.monotonic() + CALLBACK_LIMIT
    for thread in callback_threads():
        thread.join(max(limit - time.monotonic(), 0))


def _programs_threads() -> list[threading.Thread]:
    """The program's own threads that the interpreter waits for before it ends; they may still use sessions."""
    not_theirs = {threading.current_thread(), threading.main_thread(), *callback_threads()}
    return [t for t in threading.enumerate() if not t.daemon and t not in not_theirs]


def callback_threads() -> list[threading.Thread]:
    """The threads of Zenoh's that call back, one per subscriber or queryable, and those that take questions, by name.

    They end soon after their session was closed. Those that were started from a daemon thread are daemons, which the
    interpreter does not wait for; and one that asks for the GIL when the interpreter has gone aborts the process.
    """
    return [t for t in threading.enumerate() if t.name.endswith("(pyo3-closure)") or t.name == ANSWERING]
