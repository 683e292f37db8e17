"""Twist as CDR: encode and decode, beside rosbags' generated codec.

Goal: at least 4 times as fast as rosbags.
"""

from __future__ import annotations

import timeit

from rosbags.typesys import Stores, get_typestore

from benchmarks.rounds import compare, goal
from graphflow.msgs import registry
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3

NAME = "geometry_msgs/msg/Twist"
REPEAT = 50_000


def main() -> None:
    ours = registry.codec(NAME)
    store = get_typestore(Stores.ROS2_JAZZY)
    message = Twist(linear=Vector3(x=2.0), angular=Vector3(z=1.8))
    payload = ours.encode(message)
    theirs = store.deserialize_cdr(payload, NAME)
    assert bytes(store.serialize_cdr(theirs, NAME)) == payload

    def us(function: object) -> float:
        return timeit.timeit(function, number=REPEAT) / REPEAT * 1e6  # type: ignore[arg-type]

    found = compare(
        {
            "rosbags encode + decode": lambda: us(
                lambda: (store.serialize_cdr(theirs, NAME), store.deserialize_cdr(payload, NAME))
            ),
            "graphflow encode + decode": lambda: us(lambda: (ours.encode(message), ours.decode(payload))),
            "graphflow encode": lambda: us(lambda: ours.encode(message)),
            "graphflow decode": lambda: us(lambda: ours.decode(payload)),
            "graphflow make": lambda: us(lambda: Twist(linear=Vector3(x=2.0), angular=Vector3(z=1.8))),
        },
        rounds=15,
        unit="us",
        baseline="rosbags encode + decode",
    )
    goal("graphflow / rosbags", found["graphflow encode + decode"][1], 0.25)


if __name__ == "__main__":
    main()
