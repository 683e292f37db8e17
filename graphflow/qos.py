"""Quality of service profiles, with ROS 2's names and numbers.

Source: rmw_qos_profile_t and the presets of rmw/qos_profiles.h.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import IntEnum

INFINITE_NS = 9_223_372_036_854_775_807
"""The duration without limit, as in rmw: 9223372036 s and 854775807 ns."""

DEFAULT_DEPTH = 42
"""The depth that rmw_zenoh uses for a requested depth of 0."""


class Reliability(IntEnum):
    RELIABLE = 1
    BEST_EFFORT = 2
    BEST_AVAILABLE = 4
    """Adapted to the other side when the endpoint opens; never on the wire."""


class Durability(IntEnum):
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    BEST_AVAILABLE = 4
    """As `Reliability.BEST_AVAILABLE`."""


class History(IntEnum):
    KEEP_LAST = 1
    KEEP_ALL = 2


class Liveliness(IntEnum):
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3


_POLICIES: dict[str, type[IntEnum]] = {
    "reliability": Reliability,
    "durability": Durability,
    "history": History,
    "liveliness": Liveliness,
}
_DURATIONS = ("deadline_ns", "lifespan_ns", "lease_ns")


@dataclass(frozen=True, slots=True)
class Qos:
    """The profile of an endpoint. Durations are in nanoseconds; `INFINITE_NS` is no limit."""

    depth: int = 10
    """Number of messages kept with KEEP_LAST."""
    reliability: Reliability = Reliability.RELIABLE
    durability: Durability = Durability.VOLATILE
    history: History = History.KEEP_LAST
    deadline_ns: int = INFINITE_NS
    lifespan_ns: int = INFINITE_NS
    liveliness: Liveliness = Liveliness.AUTOMATIC
    lease_ns: int = INFINITE_NS

    def __post_init__(self) -> None:
        for name, kind in _POLICIES.items():
            if not isinstance(value := getattr(self, name), kind):
                raise ValueError(f"{name} of a Qos cannot be {value!r}; write {_policy_meant(value, kind)}")
        for name in ("depth", *_DURATIONS):
            value = getattr(self, name)
            if isinstance(value, IntEnum) and type(value) in _POLICIES.values():
                policy = f"{type(value).__name__}.{value.name}"
                raise ValueError(f"{name} of a Qos is a whole number; write {type(value).__name__.lower()}={policy}")
            if not isinstance(value, int) or isinstance(value, bool):
                is_time = isinstance(value, float) and name != "depth"
                hint = f"; for {value:g} seconds write {name}={round(value * 1e9):_}" if is_time else ""
                raise ValueError(f"{name} of a Qos is a whole number, not {value!r}{hint}")
            if value < 0 and name != "depth":
                raise ValueError(f"{name} of a Qos cannot be {value}; leave it out for none")
        # rmw_zenoh adapts a requested profile likewise: neither a depth nor a duration of 0 reaches the wire.
        if self.depth < 0:
            raise ValueError(f"a queue depth cannot be {self.depth}; give 1 or more")
        if not self.depth:
            object.__setattr__(self, "depth", DEFAULT_DEPTH)
        for name in _DURATIONS:
            if not getattr(self, name):
                object.__setattr__(self, name, INFINITE_NS)

    @classmethod
    def of(cls, profile: Qos | int) -> Qos:
        """Return a profile unchanged, or the default profile with a depth, ROS 2's short form.

        Raises:
            ValueError: The depth is negative.
        """
        return profile if isinstance(profile, Qos) else cls(depth=profile)

    def adapted(self, others: Iterable[Qos]) -> Qos:
        """Replace each BEST_AVAILABLE by the strongest policy that fits all of `others`.

        Args:
            others: The present profiles of the other side: of publishers for a subscription, or the reverse.
        """
        found = list(others)
        reliable = all(q.reliability is Reliability.RELIABLE for q in found)
        latched = bool(found) and all(q.durability is Durability.TRANSIENT_LOCAL for q in found)
        settled = self
        if self.reliability is Reliability.BEST_AVAILABLE:
            settled = replace(settled, reliability=Reliability.RELIABLE if reliable else Reliability.BEST_EFFORT)
        if self.durability is Durability.BEST_AVAILABLE:
            settled = replace(settled, durability=Durability.TRANSIENT_LOCAL if latched else Durability.VOLATILE)
        return settled


def _policy_meant(value: object, kind: type[IntEnum]) -> str:
    """Return the argument that was meant by a value that is none of its policies, such as a text."""
    meant = value.upper() if isinstance(value, str) else ""
    fits = next((policies for policies in (kind, *_POLICIES.values()) if meant in policies.__members__), None)
    one = next(iter(kind)) if fits is None else fits[meant]
    return f"{type(one).__name__.lower()}={type(one).__name__}.{one.name}"


def incompatible(offered: Qos, requested: Qos) -> list[str]:
    """Return the policies in which a subscription requests more than a publisher offers, so that DDS would not match.

    rmw_zenoh and graphflow deliver anyway; a graph for every middleware must have no such policies.

    Source: OMG DDS 1.4, 2.2.3; rmw_dds_common qos_profile_check_compatible.
    """
    refused = {
        "reliability": offered.reliability is Reliability.BEST_EFFORT and requested.reliability is Reliability.RELIABLE,
        "durability": offered.durability is Durability.VOLATILE and requested.durability is Durability.TRANSIENT_LOCAL,
        "deadline": offered.deadline_ns > requested.deadline_ns,
        "liveliness": offered.liveliness is Liveliness.AUTOMATIC and requested.liveliness is Liveliness.MANUAL_BY_TOPIC,
        "liveliness lease": offered.lease_ns > requested.lease_ns,
    }
    return [policy for policy, is_refused in refused.items() if is_refused]


def on_offer(offered: Qos, policies: Iterable[str]) -> str:
    """Return the offered values of policies as text: a subscription that requests these matches."""
    words = {
        "reliability": offered.reliability.name,
        "durability": offered.durability.name,
        "deadline": _span(offered.deadline_ns),
        "liveliness": offered.liveliness.name,
        "liveliness lease": _span(offered.lease_ns),
    }
    return ", ".join(f"{policy} {words[policy]}" for policy in policies)


def _span(duration_ns: int) -> str:
    return "infinite" if duration_ns >= INFINITE_NS else f"{duration_ns / 1e9:g} s"


DEFAULT = Qos()
SENSOR_DATA = Qos(depth=5, reliability=Reliability.BEST_EFFORT)
SERVICES = Qos()
PARAMETERS = Qos(depth=1000)
PARAMETER_EVENTS = Qos(depth=1000)
ROSOUT = Qos(depth=1000, durability=Durability.TRANSIENT_LOCAL, lifespan_ns=10_000_000_000)
LATCHED = Qos(depth=1, durability=Durability.TRANSIENT_LOCAL)
"""The latest message is kept for late subscribers: for maps, robot descriptions and other states that seldom change."""
ACTION_STATUS = LATCHED
CLOCK = Qos(depth=1, reliability=Reliability.BEST_EFFORT)
BEST_AVAILABLE = Qos(reliability=Reliability.BEST_AVAILABLE, durability=Durability.BEST_AVAILABLE)
SYSTEM_DEFAULT = Qos(depth=0)

PROFILES: dict[str, Qos] = {
    "default": DEFAULT,
    "sensor_data": SENSOR_DATA,
    "services_default": SERVICES,
    "parameters": PARAMETERS,
    "parameter_events": PARAMETER_EVENTS,
    "action_status_default": ACTION_STATUS,
    "rosout_default": ROSOUT,
    "best_available": BEST_AVAILABLE,
    "system_default": SYSTEM_DEFAULT,
}
"""ROS 2's profiles by the names for `ros2 topic pub --qos-profile`."""
