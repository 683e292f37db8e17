"""A client of `/fibonacci` made of bare Zenoh and bytes: `python raw_action_client.py`. Nothing of graphflow.

It drives the action through the hidden services and topics of ROS 2: one goal to its end, and one that it cancels.
"""

from __future__ import annotations

import json
import os
import struct
import sys
import threading
import time
from typing import Any

import zenoh

DOMAIN = os.environ["GRAPHFLOW_DOMAIN"]
PACKAGE = "example_interfaces::action::dds_::Fibonacci"
AT = f"{DOMAIN}/fibonacci/_action"
SEND = f"{AT}/send_goal/{PACKAGE}_SendGoal_/RIHS01_d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557"
GET = f"{AT}/get_result/{PACKAGE}_GetResult_/RIHS01_1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57"
CANCEL = (
    f"{AT}/cancel_goal/action_msgs::srv::dds_::CancelGoal_/"
    "RIHS01_573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a"
)
FEEDBACK = (
    f"{AT}/feedback/{PACKAGE}_FeedbackMessage_/RIHS01_c1de71afd52e49a89c53d8262366884185bc0a02f78ce051c4e46b0a7fe59bb2"
)
STATUS = (
    f"{AT}/status/action_msgs::msg::dds_::GoalStatusArray_/"
    "RIHS01_6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e"
)
HEADER = b"\0\1\0\0"
GID = os.urandom(16)
LIMIT = 20.0
CANCELED = 5

config = zenoh.Config()
for key, value in {
    "mode": "peer",
    "scouting/multicast/enabled": False,
    "listen/endpoints": ["tcp/127.0.0.1:0"],
    "connect/endpoints": [os.environ["GRAPHFLOW_RENDEZVOUS"]],
}.items():
    config.insert_json5(key, json.dumps(value))
session: Any = zenoh.open(config)
sequence = 0
cancel_shown, second_told = threading.Event(), threading.Event()


def say(*words: object) -> None:
    sys.stdout.write(" ".join(map(str, words)) + "\n")
    sys.stdout.flush()


def call(key: str, request: bytes) -> bytes:
    """Ask as rmw_zenoh does; the response without its header. Waits until there is a server."""
    global sequence
    deadline = time.monotonic() + LIMIT
    while time.monotonic() < deadline:
        sequence += 1
        beside = struct.pack("<qqB", sequence, time.time_ns(), 16) + GID
        replies = session.get(
            key,
            payload=HEADER + request,
            attachment=beside,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=LIMIT,
        )
        for reply in replies:
            assert reply.ok is not None, reply.err.payload.to_string()
            back = reply.ok.attachment.to_bytes()
            assert struct.unpack("<q", back[:8])[0] == sequence
            assert (back[16], back[17:]) == (16, GID)
            payload: bytes = reply.ok.payload.to_bytes()
            assert payload[:4] == HEADER
            return payload[4:]
        time.sleep(0.05)
    raise TimeoutError(key)


def numbers(data: bytes) -> tuple[int, ...]:
    """A sequence of int32."""
    (count,) = struct.unpack_from("<I", data)
    return struct.unpack_from(f"<{count}i", data, 4)


def heard_feedback(sample: Any) -> None:
    data = sample.payload.to_bytes()[4:]
    say("FEEDBACK", data[:16].hex()[:4], *numbers(data[16:]))
    if data[:16] == second:
        second_told.set()


def heard_status(sample: Any) -> None:
    data = sample.payload.to_bytes()[4:]
    (count,) = struct.unpack_from("<I", data)
    # GoalInfo is 16 + 8 bytes, the state one more, padded to 4 for the next entry's stamp.
    entries = [data[4 + 28 * i : 4 + 28 * i + 25] for i in range(count)]
    say("STATUS", *(f"{entry[:2].hex()}:{entry[24]}" for entry in entries))
    if any(entry[24] == CANCELED for entry in entries):
        cancel_shown.set()


def send(goal_id: bytes, order: int) -> None:
    answer = call(SEND, goal_id + struct.pack("<i", order))
    accepted, seconds = answer[0], struct.unpack_from("<i", answer, 4)[0]
    assert abs(seconds - time.time()) < 60
    say("ACCEPTED", goal_id.hex()[:4], accepted)


def result(goal_id: bytes) -> None:
    answer = call(GET, goal_id)
    say("RESULT", goal_id.hex()[:4], answer[0], *numbers(answer[4:]))


subscriptions = session.declare_subscriber(FEEDBACK, heard_feedback), session.declare_subscriber(STATUS, heard_status)
first, second = b"\x11" * 16, b"\x22" * 16
send(first, 3)
result(first)
result(first)
send(second, 40)
assert second_told.wait(LIMIT)
answer = call(CANCEL, second + struct.pack("<iI", 0, 0))
code, count = answer[0], struct.unpack_from("<I", answer, 4)[0]
say("CANCEL", code, count, answer[8:10].hex())
result(second)
answer = call(CANCEL, second + struct.pack("<iI", 0, 0))
say("CANCEL", answer[0], struct.unpack_from("<I", answer, 4)[0])
answer = call(CANCEL, b"\x33" * 16 + struct.pack("<iI", 0, 0))
say("CANCEL", answer[0], struct.unpack_from("<I", answer, 4)[0])
result(b"\x33" * 16)
# Topics and replies come on threads of their own: the last status may come after the results.
assert cancel_shown.wait(LIMIT)
say("DONE")
os._exit(0)
