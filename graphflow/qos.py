"""Quality of service: what a publisher offers and a subscription asks for, in ROS 2's words and numbers.

Source: rmw_qos_profile_t and the presets of rmw/qos_profiles.h.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

INFINITE_NS = 9_223_372_036_854_775_807
"""No limit, as rmw writes it: 9223372036 s and 854775807 ns."""

DEFAULT_DEPTH = 42
"""The depth rmw_zenoh gives an endpoint that asked for 0."""


class Reliability(IntEnum):
    RELIABLE = 1
    BEST_EFFORT = 2


class Durability(IntEnum):
    TRANSIENT_LOCAL = 1
    VOLATILE = 2


class History(IntEnum):
    KEEP_LAST = 1
    KEEP_ALL = 2


class Liveliness(IntEnum):
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3


@dataclass(frozen=True, slots=True)
class Qos:
    """One endpoint's profile. Durations are in nanoseconds, `INFINITE_NS` for none."""

    depth: int = 10
    """Messages kept, for KEEP_LAST."""
    reliability: Reliability = Reliability.RELIABLE
    durability: Durability = Durability.VOLATILE
    history: History = History.KEEP_LAST
    deadline_ns: int = INFINITE_NS
    lifespan_ns: int = INFINITE_NS
    liveliness: Liveliness = Liveliness.AUTOMATIC
    lease_ns: int = INFINITE_NS

    def __post_init__(self) -> None:
        # rmw_zenoh adapts a requested profile likewise: no depth and no duration of 0 reaches the wire.
        if self.depth < 0:
            raise ValueError(f"a queue depth cannot be {self.depth}; give 1 or more")
        if not self.depth:
            object.__setattr__(self, "depth", DEFAULT_DEPTH)
        for name in ("deadline_ns", "lifespan_ns", "lease_ns"):
            if not getattr(self, name):
                object.__setattr__(self, name, INFINITE_NS)

    @classmethod
    def of(cls, profile: Qos | int) -> Qos:
        """A profile as it is, or ROS 2's short form: a number is the depth of the default profile.

        Raises:
            ValueError: A negative depth.
        """
        return profile if isinstance(profile, Qos) else cls(depth=profile)


DEFAULT = Qos()
SENSOR_DATA = Qos(depth=5, reliability=Reliability.BEST_EFFORT)
SERVICES = Qos()
PARAMETERS = Qos(depth=1000)
ROSOUT = Qos(depth=1000, durability=Durability.TRANSIENT_LOCAL, lifespan_ns=10_000_000_000)
