"""Talkers and listeners, a server and a client for peers that are not graphflow; a script that runs one by name."""

from __future__ import annotations

import sys

import numpy as np

import graphflow
from graphflow import CallError, Client, Node, Publisher, service, subscription, task, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.msgs.std_msgs.msg import Header, String

PIXELS = (np.arange(480 * 640 * 3) % 251).astype(np.uint8)


class HearString(Node):
    @subscription(String, "from_sdk")
    async def heard(self, m: String) -> None:
        print("HEARD", m.data, flush=True)


class HearTwist(Node):
    @subscription(Twist, "from_sdk")
    async def heard(self, m: Twist) -> None:
        print("HEARD", (m.linear.x, m.linear.z, m.angular.y), flush=True)


class HearImage(Node):
    @subscription(Image, "from_sdk")
    async def heard(self, m: Image) -> None:
        print("HEARD", (m.header.frame_id, m.step, bool((m.data == PIXELS).all())), flush=True)


class SayString(Node):
    chatter = Publisher(String, "chatter")

    @timer(0.05)
    async def say(self) -> None:
        self.chatter.publish(String(data="hello grüße"))


class SayTwist(Node):
    twist = Publisher(Twist, "twist")

    @timer(0.05)
    async def say(self) -> None:
        self.twist.publish(Twist(linear=Vector3(x=1.5, z=0.25), angular=Vector3(y=0.5)))


class SayImage(Node):
    image = Publisher(Image, "image")

    @timer(0.05)
    async def say(self) -> None:
        header = Header(frame_id="camera", stamp=self.clock.now())
        self.image.publish(Image(header=header, height=480, width=640, encoding="rgb8", step=1920, data=PIXELS))


class Adder(Node):
    @service(AddTwoInts, "add_two_ints")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)


class Caller(Node):
    adder = Client(AddTwoInts, "add_sdk")

    @task
    async def ask(self) -> None:
        await self.adder.wait_ready(15.0)
        for a in (2, 40, -1):
            try:
                print("HEARD", (await self.adder.call(AddTwoInts.Request(a=a, b=3))).sum, flush=True)
            except CallError as error:
                print("HEARD", type(error).__name__, flush=True)


if __name__ == "__main__":
    graphflow.run(globals()[sys.argv.pop(1)])
