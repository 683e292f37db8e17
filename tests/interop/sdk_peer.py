"""zenoh-ros2-sdk's side of a conversation: `python sdk_peer.py ROLE`, at the rendezvous and in the domain of the test.

It prints what it hears, a line each. The definitions are graphflow's own files: left to itself it would clone them.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import zenoh_ros2_sdk as sdk

import graphflow

PORT = int(os.environ["GRAPHFLOW_RENDEZVOUS"].rpartition(":")[2])
WHERE: dict[str, Any] = {
    "domain_id": int(os.environ["GRAPHFLOW_DOMAIN"]),
    "router_ip": "127.0.0.1",
    "router_port": PORT,
}
PIXELS = (np.arange(480 * 640 * 3) % 251).astype(np.uint8)
STOP = threading.Event()


def say(*words: object) -> None:
    sys.stdout.write(" ".join(map(str, words)) + "\n")
    sys.stdout.flush()


def hear(topic: str, type_name: str, show: Any) -> None:
    subscriber = sdk.ROS2Subscriber(topic, type_name, lambda m: say("HEARD", show(m)), **WHERE)
    say("READY")
    STOP.wait(60)
    subscriber.close()


def speak(topic: str, type_name: str, **fields: Any) -> None:
    publisher = sdk.ROS2Publisher(topic, type_name, **WHERE)
    say("READY")
    while not STOP.wait(0.05):
        publisher.publish(**fields)
    publisher.close()


def serve() -> None:
    response = classes("example_interfaces/srv/AddTwoInts_Response")

    def add(request: Any) -> Any:
        if request.a < 0:
            raise ValueError("negative")
        return response(sum=request.a + request.b)

    server = sdk.ROS2ServiceServer("/add_sdk", "example_interfaces/srv/AddTwoInts", add, **WHERE)
    say("READY")
    STOP.wait(60)
    server.close()


def call() -> None:
    client = sdk.ROS2ServiceClient("/add_two_ints", "example_interfaces/srv/AddTwoInts", timeout=5.0, **WHERE)
    while not (info := sdk.get_service_info("/add_two_ints", **WHERE)) or not info.server_count:
        if STOP.wait(0.1):
            return
    for a in (2, 40):
        answer = client.call(a=a, b=3)
        say("HEARD", None if answer is None else answer.sum)
    client.close()


def look() -> None:
    while not STOP.wait(0.1):
        for name, types in sdk.get_topic_names_and_types(**WHERE):
            say("TOPIC", name, *types)
        for name, types in sdk.get_service_names_and_types(**WHERE):
            say("SERVICE", name, *types)


# In this order: the registry is made once, and it would open a session at port 7447 were there none.
registry = sdk.get_registry(str(Path(graphflow.__file__).parent / "msgs"))
session = sdk.ZenohSession.get_instance("127.0.0.1", PORT)
classes = registry.get_message_class
sdk.load_service_type("example_interfaces/srv/AddTwoInts")

for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, lambda *_: STOP.set())
match sys.argv[1]:
    case "hear-string":
        hear("/chatter", "std_msgs/msg/String", lambda m: m.data)
    case "say-string":
        speak("/from_sdk", "std_msgs/msg/String", data="hello grüße")
    case "hear-twist":
        hear("/twist", "geometry_msgs/msg/Twist", lambda m: (m.linear.x, m.linear.z, m.angular.y))
    case "say-twist":
        vector = classes("geometry_msgs/msg/Vector3")
        linear, angular = vector(x=1.5, y=-2.0, z=0.25), vector(x=0.0, y=0.5, z=3.0)
        speak("/from_sdk", "geometry_msgs/msg/Twist", linear=linear, angular=angular)
    case "hear-image":
        hear("/image", "sensor_msgs/msg/Image", lambda m: (m.header.frame_id, m.step, bool((m.data == PIXELS).all())))
    case "say-image":
        stamp = classes("builtin_interfaces/msg/Time")(sec=7, nanosec=8)
        header = classes("std_msgs/msg/Header")(stamp=stamp, frame_id="camera")
        size = {"height": 480, "width": 640, "step": 1920, "encoding": "rgb8", "is_bigendian": 0}
        speak("/from_sdk", "sensor_msgs/msg/Image", header=header, data=PIXELS, **size)
    case "serve":
        serve()
    case "call":
        call()
    case "look":
        look()
# Without it a process with a queryable does not end.
session.close()
