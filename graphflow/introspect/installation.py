"""The installation: its origin, and faults of versions and the environment that can be found without a graph."""

from __future__ import annotations

import json
import os
import shlex
from collections.abc import Callable, Iterator, Mapping
from importlib import metadata
from pathlib import Path
from types import ModuleType
from urllib.parse import unquote, urlsplit

from graphflow.domain import DEFAULT_ENDPOINT, DOMAIN_VARIABLES, rendezvous_endpoint
from graphflow.wire.profile import PROFILES, VARIABLE

DISTRIBUTION = "graphflow-zenoh"
RMW = "rmw_zenoh_cpp"
OLDEST_ZENOH = (1, 10)
"""The oldest version of eclipse-zenoh with which graphflow was tested."""


def requirement(extra: str = "") -> str:
    """Return pip's arguments that install the running graphflow, quoted for a shell.

    It may not be on an index, so the requirement names its origin: a folder, a file or a repository.

    Args:
        extra: An extra to install with it.

    Source: PEP 610, direct_url.json.
    """
    name = DISTRIBUTION + (f"[{extra}]" if extra else "")
    try:
        origin = json.loads(metadata.distribution(DISTRIBUTION).read_text("direct_url.json") or "{}")
    except metadata.PackageNotFoundError:
        origin = {}
    url = origin.get("url", "")
    if "dir_info" in origin:
        folder = shlex.quote(unquote(urlsplit(url).path) + name.removeprefix(DISTRIBUTION))
        return f"-e {folder}" if origin["dir_info"].get("editable") else folder
    if vcs := origin.get("vcs_info"):
        url = f"{vcs['vcs']}+{url}@{vcs['commit_id']}"
    return shlex.quote(f"{name} @ {url}" if url else name)


def faults(env: Mapping[str, str], version: Callable[[str], str | None]) -> Iterator[str]:
    """Yield faults that keep graphflow from working, or from being visible to the ROS 2 of this shell.

    Args:
        env: The environment.
        version: Returns the version of an installed distribution; None if it is not installed.
    """
    if other := version("graphflow"):
        yield (
            f"another package called graphflow is installed ({other}), whose modules may be imported instead: "
            f"pip uninstall graphflow, then: pip install --force-reinstall {requirement()}"
        )
    zenoh = version("eclipse-zenoh")
    if zenoh is not None and _numbers(zenoh) < OLDEST_ZENOH:
        yield f"eclipse-zenoh {zenoh} is too old: pip install -U 'eclipse-zenoh>={'.'.join(map(str, OLDEST_ZENOH))}'"
    if env.get("AMENT_PREFIX_PATH"):
        yield from _sourced(env)


def recompiled(module: ModuleType, *, writes: bool) -> Iterator[str]:
    """Explain why each start compiles graphflow, which makes it several times slower; nothing if it does not.

    Args:
        module: An imported module, whose compiled form Python has cached if it could.
        writes: Whether Python may cache it.
    """
    cached = module.__spec__.cached if module.__spec__ is not None else None
    if cached is None or os.path.exists(cached):
        return
    why = f"{os.path.dirname(cached)} cannot be written" if writes else "PYTHONDONTWRITEBYTECODE is set"
    yield (
        f"each start compiles graphflow again: {why}; compile it once, with write permission: "
        f"python -m compileall -q {shlex.quote(str(Path(__file__).parents[1]))}"
    )


def _sourced(env: Mapping[str, str]) -> Iterator[str]:
    """Yield differences that separate graphflow from the ROS 2 sourced in this shell."""
    rmw, distro = env.get("RMW_IMPLEMENTATION", ""), env.get("ROS_DISTRO", "")
    if rmw != RMW:
        yield (
            f"ROS 2 is sourced here, but its nodes will not be visible: they use {rmw or 'DDS'}; "
            f"export RMW_IMPLEMENTATION={RMW}"
        )
    profile = env.get(VARIABLE) or PROFILES[0]
    if distro in PROFILES and distro != profile:
        ours_is = f"graphflow uses {profile}'s definitions"
        yield f"ROS 2 {distro} is sourced here, but {ours_is}: export GRAPHFLOW_WIRE={distro}"
    if distro == "humble":
        yield "ROS 2 humble is sourced here, which has no type hashes: its nodes and graphflow's cannot communicate"
    ours, theirs = (env.get(name) for name in DOMAIN_VARIABLES)
    if ours is not None and ours != (theirs or "0"):
        yield f"GRAPHFLOW_DOMAIN is {ours}, but ROS 2's nodes are in domain {theirs or 0}: unset GRAPHFLOW_DOMAIN"
    if rendezvous_endpoint() != DEFAULT_ENDPOINT and "ZENOH_CONFIG_OVERRIDE" not in env:
        yield (
            f"ROS 2 is sourced here; its nodes connect to {DEFAULT_ENDPOINT}, graphflow's to {rendezvous_endpoint()}: "
            "unset GRAPHFLOW_RENDEZVOUS"
        )


def _numbers(version: str) -> tuple[int, ...]:
    """Parse the first two numbers of a version: `1.10.2` is (1, 10)."""
    return tuple(int(part) for part in version.split(".")[:2] if part.isdecimal())
