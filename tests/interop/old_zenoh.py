"""A bare peer or router of whatever Zenoh version is on the path: `python old_zenoh.py ROLE`. Nothing of graphflow.

It speaks rmw_zenoh's wire for std_msgs/msg/String on `/chatter`, and prints what it hears, a line each.
"""

from __future__ import annotations

import json
import os
import signal
import struct
import sys
import threading
import time
from typing import Any

import zenoh

DOMAIN = os.environ["GRAPHFLOW_DOMAIN"]
HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
TYPE = "std_msgs::msg::dds_::String_"
KEY = f"{DOMAIN}/chatter/{TYPE}/{HASH}"
GID = os.urandom(16)
STOP = threading.Event()
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda *_: STOP.set())

role = sys.argv[1]
settings: dict[str, object] = {
    "mode": "router" if role == "router" else "peer",
    "scouting/multicast/enabled": False,
    "timestamping/enabled": True,
    "listen/endpoints": [os.environ["GRAPHFLOW_RENDEZVOUS"] if role == "router" else "tcp/127.0.0.1:0"],
    "connect/endpoints": [] if role == "router" else [os.environ["GRAPHFLOW_RENDEZVOUS"]],
}
config = zenoh.Config()
for key, value in settings.items():
    config.insert_json5(key, json.dumps(value))
session: Any = zenoh.open(config)


def say(*words: object) -> None:
    sys.stdout.write(" ".join(map(str, words)) + "\n")
    sys.stdout.flush()


def announce(kind: str, qos: str) -> Any:
    me = f"@ros2_lv/{DOMAIN}/{session.info.zid()}"
    tokens = session.liveliness()
    entity = f"{me}/0/1/{kind}/%/%/old/%chatter/{TYPE}/{HASH}/{qos}"
    return tokens.declare_token(f"{me}/0/0/NN/%/%/old"), tokens.declare_token(entity)


def message(n: int) -> tuple[bytes, bytes]:
    text = f"old {n}".encode() + b"\0"
    return b"\0\1\0\0" + struct.pack("<I", len(text)) + text, struct.pack("<qqB", n, time.time_ns(), 16) + GID


def heard(sample: Any) -> None:
    payload, beside = sample.payload.to_bytes(), sample.attachment.to_bytes()
    say("HEARD", payload[8:-1].decode(), len(beside))


def ext() -> Any:
    import zenoh.ext

    return zenoh.ext


keep: list[Any] = []
if role == "say":
    publisher = session.declare_publisher(KEY)
    keep.append(announce("MP", "::,10:,:,:,,"))
    n = 0
    while not STOP.wait(0.05):
        n += 1
        payload, beside = message(n)
        publisher.put(payload, attachment=beside)
elif role == "say-latched":
    publisher = ext().declare_advanced_publisher(
        session,
        KEY,
        cache=ext().CacheConfig(max_samples=3),
        publisher_detection=True,
        sample_miss_detection=ext().MissDetectionConfig(heartbeat=None, sporadic_heartbeat=0.5),
    )
    keep.append(announce("MP", ":1:,3:,:,:,,"))
    for n in range(1, 6):
        payload, beside = message(n)
        publisher.put(payload, attachment=beside)
    say("SAID")
    STOP.wait(60)
elif role == "hear":
    keep.append((session.declare_subscriber(KEY, heard), announce("MS", "::,10:,:,:,,")))
    say("READY")
    STOP.wait(60)
elif role == "hear-latched":
    subscriber = ext().declare_advanced_subscriber(
        session,
        KEY,
        heard,
        history=ext().HistoryConfig(detect_late_publishers=True, max_samples=3),
        recovery=ext().RecoveryConfig(periodic_queries=None, heartbeat=True),
        subscriber_detection=True,
    )
    keep.append(announce("MS", ":1:,3:,:,:,,"))
    say("READY")
    STOP.wait(60)
    subscriber.undeclare()  # without it 1.5.1 and 1.7.2 do not end
else:
    say("READY")
    STOP.wait(60)
session.close()
