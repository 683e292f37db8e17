"""Wire profiles: the definitions used in keys and tokens, a few of which differ between ROS 2's distributions.

| | jazzy | kilted | lyrical |
|---|---|---|---|
| package of turtlesim's interfaces | turtlesim | turtlesim_msgs | turtlesim_msgs |
| lifecycle_msgs/msg/TransitionEvent | uint64 timestamp | uint64 timestamp | Time stamp |
| a chunk about buffers in tokens of uint8[] topics | no | no | yes |
| version of nav2_msgs | 1.3 | 1.4 | 1.5 |
| version of simulation_interfaces | 1.5 | 1.6, which is 1.5 | 2.1 |

The definitions that a profile has of its own are in `msgs/<profile>`. Everything else on the wire is the same in all
three. Humble has no type hashes at all, and is recognised by that.

Source: rcl_interfaces 2.4.3; ros_tutorials 1.9.2; rmw_zenoh_cpp 0.10; navigation2 1.3.13, 1.4.2 and 1.5.1.
"""

from __future__ import annotations

import os

from graphflow.errors import GraphflowError
from graphflow.names import did_you_mean
from graphflow.wire.liveliness import Entity

PROFILES = ("jazzy", "kilted", "lyrical")
VARIABLE = "GRAPHFLOW_WIRE"

_TRANSITION_EVENT = "lifecycle_msgs/msg/TransitionEvent"
_LYRICAL_TRANSITION_EVENT = "RIHS01_78b19e2be41a797fc009c96bda68944182edabec7852cccd928a40bc06f6f9d7"


def wire_profile() -> str:
    """Return this process's profile: GRAPHFLOW_WIRE, else jazzy.

    Raises:
        GraphflowError: The variable has another value than a profile's name.
    """
    profile = os.environ.get(VARIABLE, "").strip() or PROFILES[0]
    if profile not in PROFILES:
        raise GraphflowError(f"{VARIABLE}={profile!r} is not a wire profile{did_you_mean(profile, PROFILES)}")
    return profile


def wire_type(name: str, profile: str) -> str:
    """Return the name of an interface on a profile's wire."""
    package, _, rest = name.partition("/")
    return f"turtlesim_msgs/{rest}" if package == "turtlesim" and profile != "jazzy" else name


def speakers(entity: Entity) -> tuple[str, ...]:
    """Return the profiles that an endpoint may use, judged by its token; empty if that is unknown."""
    if entity.hash == "TypeHashNotSupported":
        return ("humble",)
    # Lyrical's endpoints of types with uint8[] describe their buffers in an additional chunk.
    if "/backends:" in entity.token:
        return ("lyrical",)
    if entity.type == _TRANSITION_EVENT:
        return ("lyrical",) if entity.hash == _LYRICAL_TRANSITION_EVENT else ("jazzy", "kilted")
    package = entity.type.partition("/")[0]
    return {"turtlesim": ("jazzy",), "turtlesim_msgs": ("kilted", "lyrical")}.get(package, ())


def advice(entity: Entity, profile: str) -> str:
    """Advise on a peer whose token is of another profile than this process's; empty if it is not."""
    spoken = speakers(entity)
    if not spoken or profile in spoken:
        return ""
    if spoken == ("humble",):
        return "it speaks ROS 2 Humble's wire, which has no type hashes and is not supported"
    theirs = " or ".join(p.capitalize() for p in spoken)
    return (
        f"it speaks the wire of ROS 2 {theirs}, this process speaks {profile.capitalize()}'s: "
        f"start with --wire {spoken[0]}, or set {VARIABLE}={spoken[0]}"
    )
