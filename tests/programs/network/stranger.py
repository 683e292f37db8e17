"""A process that announces the rendezvous of another user, on another machine."""

from __future__ import annotations

import time

import zenoh

CONFIG = '{mode: "client", connect: {endpoints: ["tcp/127.0.0.1:7447"]}}'

session = zenoh.open(zenoh.Config.from_json5(CONFIG))
token = session.liveliness().declare_token("@graphflow/rendezvous/1234/12345/1")
print("declared", flush=True)
time.sleep(60)
