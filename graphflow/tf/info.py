"""The records of received frames and their publishers."""

from __future__ import annotations

from dataclasses import dataclass

from graphflow.times import Time


@dataclass(frozen=True, slots=True)
class FrameInfo:
    """The transforms of one frame, as a node receives them.

    Attributes:
        publisher: The full name of the node that publishes it; "" if that has ended.
        rate: Transforms per second over the time that is kept; 0 for a static frame, and for a single transform.
        newest: The time of the newest transform.
        delay, longest_delay: Seconds from a transform's time to its arrival: on average, and at most.
        silent: Seconds since the latest transform arrived.
    """

    frame: str
    parent: str
    publisher: str
    is_static: bool
    rate: float
    newest: Time
    delay: float
    longest_delay: float
    silent: float


@dataclass(slots=True)
class Sender:
    """The latest publisher of a frame.

    Attributes:
        received_ns: When its latest transform arrived, by the node's clock.
        count, delays_ns, longest_ns: The number of its transforms, and the sum and the longest of their delays.
        parent: The parent that it gives the frame.
        former: The GIDs of those before it, each with its parent.
    """

    gid: bytes
    parent: str = ""
    former: frozenset[tuple[bytes, str]] = frozenset()
    received_ns: int = 0
    count: int = 0
    delays_ns: int = 0
    longest_ns: int = 0
