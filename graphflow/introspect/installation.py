"""The installation: versions, origin, and faults of it and of the environment, found without a graph."""

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
"""The first version of eclipse-zenoh that graphflow was tried with."""


def requirement(extra: str = "") -> str:
    """The words with which pip installs the graphflow that runs, quoted for a shell.

    It may be on no index: it is installed from where this one came, be it a folder, a file or a repository.

    Args:
        extra: One of its extras, to be installed with it.

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
    """What keeps graphflow from working, or from being seen by the ROS 2 of this shell.

    Args:
        env: The environment.
        version: The version of an installed distribution; None where there is none.
    """
    if other := version("graphflow"):
        yield (
            f"another package called graphflow is installed ({other}), whose modules may come in the place of these: "
            f"pip uninstall graphflow, then: pip install --force-reinstall {requirement()}"
        )
    zenoh = version("eclipse-zenoh")
    if zenoh is not None and _numbers(zenoh) < OLDEST_ZENOH:
        yield f"eclipse-zenoh {zenoh} is too old: pip install -U 'eclipse-zenoh>={'.'.join(map(str, OLDEST_ZENOH))}'"
    if env.get("AMENT_PREFIX_PATH"):
        yield from _sourced(env)


def compiled_anew(module: ModuleType, *, writes: bool) -> Iterator[str]:
    """Why each start compiles graphflow, which takes it several times as long.

    Args:
        module: A module that has been imported: Python has kept what it compiled, or could not.
        writes: Whether Python may keep it.
    """
    cached = module.__spec__.cached if module.__spec__ is not None else None
    if cached is None or os.path.exists(cached):
        return
    why = f"{os.path.dirname(cached)} cannot be written" if writes else "PYTHONDONTWRITEBYTECODE is set"
    yield (
        f"each start compiles graphflow anew: {why}; compile it once, with the rights to write there: "
        f"python -m compileall -q {shlex.quote(str(Path(__file__).parents[1]))}"
    )


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
