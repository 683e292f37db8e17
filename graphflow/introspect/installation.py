"""What is wrong with what is installed, and with the environment: found without a graph."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from graphflow.domain import DEFAULT_ENDPOINT, DOMAIN_VARIABLES, rendezvous_endpoint
from graphflow.wire.profile import PROFILES, VARIABLE

RMW = "rmw_zenoh_cpp"
OLDEST_ZENOH = (1, 10)
"""The first version of eclipse-zenoh that graphflow was tried with."""


def faults(env: Mapping[str, str], version: Callable[[str], str | None]) -> Iterator[str]:
    """What keeps graphflow from working, or from being seen by the ROS 2 of this shell.

    Args:
        env: The environment.
        version: The version of an installed distribution; None where there is none.
    """
    if other := version("graphflow"):
        yield (
            f"another package called graphflow is installed ({other}), whose modules may come in the place of these: "
            "pip uninstall graphflow, then install graphflow-zenoh again"
        )
    zenoh = version("eclipse-zenoh")
    if zenoh is not None and _numbers(zenoh) < OLDEST_ZENOH:
        yield f"eclipse-zenoh {zenoh} is too old: pip install -U 'eclipse-zenoh>={'.'.join(map(str, OLDEST_ZENOH))}'"
    if env.get("AMENT_PREFIX_PATH"):
        yield from _sourced(env)


def _sourced(env: Mapping[str, str]) -> Iterator[str]:
    """What keeps graphflow and the ROS 2 that is sourced in this shell apart."""
    rmw, distro = env.get("RMW_IMPLEMENTATION", ""), env.get("ROS_DISTRO", "")
    if rmw != RMW:
        yield (
            f"ROS 2 is sourced here, and its nodes will not be seen: they speak {rmw or 'DDS'}; "
            f"export RMW_IMPLEMENTATION={RMW}"
        )
    profile = env.get(VARIABLE) or PROFILES[0]
    if distro in PROFILES and distro != profile:
        speaks = f"graphflow speaks as {profile}"
        yield f"ROS 2 {distro} is sourced here, and {speaks}: export GRAPHFLOW_WIRE={distro}"
    if distro == "humble":
        yield "ROS 2 humble is sourced here, which has no type hashes: its nodes and graphflow's do not hear each other"
    ours, theirs = (env.get(name) for name in DOMAIN_VARIABLES)
    if ours is not None and ours != (theirs or "0"):
        yield f"GRAPHFLOW_DOMAIN is {ours}, and ROS 2's nodes are in domain {theirs or 0}: unset GRAPHFLOW_DOMAIN"
    if rendezvous_endpoint() != DEFAULT_ENDPOINT and "ZENOH_CONFIG_OVERRIDE" not in env:
        yield (
            f"ROS 2 is sourced here, whose nodes look at {DEFAULT_ENDPOINT}, and graphflow at {rendezvous_endpoint()}: "
            "unset GRAPHFLOW_RENDEZVOUS"
        )


def _numbers(version: str) -> tuple[int, ...]:
    """`1.10.2` as numbers; what follows them is left out."""
    return tuple(int(part) for part in version.split(".")[:2] if part.isdecimal())
