"""A Zenoh router with the settings that rmw_zenoh ships for its own, and nothing of graphflow."""

from __future__ import annotations

import signal
import threading

import zenoh

SETTINGS = """{
  mode: "router",
  listen: { endpoints: ["tcp/[::]:7447"] },
  connect: { timeout_ms: { router: -1 }, exit_on_failure: { router: false } },
  scouting: {
    multicast: { enabled: false },
    gossip: {
      enabled: true, multihop: false,
      target: { router: ["router", "peer"], peer: ["router"] },
      autoconnect: { router: [], peer: ["router", "peer"] },
    },
  },
  timestamping: { enabled: { router: true, peer: true, client: true } },
  queries_default_timeout: 600000,
  routing: { router: { peers_failover_brokering: false } },
  transport: {
    unicast: { open_timeout: 60000, accept_timeout: 60000, accept_pending: 10000, max_sessions: 10000 },
    link: { tx: { lease: 60000, keep_alive: 2 } },
    shared_memory: { enabled: false },
  },
  adminspace: { enabled: true, permissions: { read: true, write: false } },
}"""

stop = threading.Event()
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda *_: stop.set())
with zenoh.open(zenoh.Config.from_json5(SETTINGS)):
    print("router up", flush=True)
    stop.wait()
