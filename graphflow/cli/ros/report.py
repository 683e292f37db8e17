"""The report of `doctor --report` on this system, the installation and the graph, in ROS 2's sections."""

from __future__ import annotations

import os
import platform
import socket
import sys
from collections.abc import Collection, Iterator
from importlib import metadata

from graphflow import __version__
from graphflow.domain import domain_id, rendezvous_endpoint
from graphflow.introspect.graph_view import View
from graphflow.machines.matching import complaints
from graphflow.wire.liveliness import Kind
from graphflow.wire.profile import wire_profile

_CHECKS = {
    "ROS 2 INFORMATION": "installation",
    "TOPIC LIST": "health",
    "QOS COMPATIBILITY LIST": "misfits",
}
"""Sections that belong to a check; the others are printed only in a full report."""
_VARIABLES = ("ROS_DISTRO", "ROS_DOMAIN_ID", "GRAPHFLOW_DOMAIN", "RMW_IMPLEMENTATION", "GRAPHFLOW_RENDEZVOUS")


def sections(failed: Collection[str] | None) -> Iterator[str]:
    """Yield the lines of a report.

    Args:
        failed: Failed checks, to which the report is limited; None for a full report.
    """
    with View(domain_id()) as view:
        graph = _graph(view)
    for title, rows in {**_installed(), **graph}.items():
        if failed is None or _CHECKS.get(title) in failed:
            yield from _section(title, rows)


def installed() -> Iterator[str]:
    """Yield the lines of a report without a running graph."""
    for title, rows in _installed().items():
        yield from _section(title, rows)


def _section(title: str, rows: Collection[tuple[str, object]]) -> Iterator[str]:
    width = max((len(key) for key, _ in rows), default=0)
    yield f"\n   {title}"
    yield from (f"{key:<{width}} : {value}" for key, value in rows)


def _installed() -> dict[str, list[tuple[str, object]]]:
    packages = {d.metadata["Name"]: d.version for d in metadata.distributions()}
    needed = [line.split(";")[0] for line in metadata.requires("graphflow-zenoh") or () if "extra ==" not in line]
    names = sorted(
        {"graphflow-zenoh", *("".join(c if c.isalnum() or c in "-_." else " " for c in n).split()[0] for n in needed)}
    )
    return {
        "PLATFORM INFORMATION": [
            ("system", platform.system()),
            ("platform info", platform.platform()),
            ("release", platform.release()),
            ("processor", platform.machine()),
            ("cores", os.cpu_count()),
            ("python", sys.version.split()[0]),
        ],
        "ROS 2 INFORMATION": [
            ("graphflow", __version__),
            ("wire profile", wire_profile()),
            *((name, os.environ.get(name, "not set")) for name in _VARIABLES),
        ],
        "NETWORK CONFIGURATION": [("host", socket.gethostname()), ("rendezvous", rendezvous_endpoint())],
        "RMW MIDDLEWARE": [("middleware name", "rmw_zenoh_cpp, as graphflow speaks it")],
        "PACKAGE VERSIONS": [(name, packages.get(name, "not installed")) for name in names],
    }


def _graph(view: View) -> dict[str, list[tuple[str, object]]]:
    cache = view.cache
    topics: list[tuple[str, object]] = []
    for name in cache.topics():
        publishers, subscriptions = (len(cache.endpoints(kind, name)) for kind in (Kind.PUBLISHER, Kind.SUBSCRIPTION))
        topics += [("topic", name), ("publisher count", publishers), ("subscriber count", subscriptions)]
    return {
        "NODES": [("node", name) for name in cache.nodes(hidden=False)],
        "TOPIC LIST": topics or [("topic", "none")],
        "QOS COMPATIBILITY LIST": [("misfit", text) for text in complaints(cache)]
        or [("compatibility status", "no incompatible QoS found")],
    }
