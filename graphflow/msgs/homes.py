"""The modules that define a type of a given name, for errors about names that nothing imports."""

from __future__ import annotations

from graphflow.msgs.registry import KINDS, names_in, packages

_COMMON = ("std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "std_srvs", "example_interfaces", "turtlesim")
"""Packages that come first, in this order."""
SHOWN = 2
"""Modules that a hint names, at most."""


def homes(name: str) -> list[str]:
    """Return the modules with a message, service or action of a name, such as `geometry_msgs.msg`."""
    found = [f"{package}.{kind}" for package in packages() for kind in KINDS if name in names_in(package, kind)]
    order = {package: place for place, package in enumerate(_COMMON)}
    return sorted(found, key=lambda home: (order.get(home.partition(".")[0], len(order)), home))


def imports(name: str, before: str = "") -> str:
    """Return the lines that import a type, as the end of a sentence; "" if there is none of that name.

    Args:
        before: The package of all such modules, with a dot, as `graphflow.msgs.`.
    """
    lines = [f"from {before}{home} import {name}" for home in homes(name)[:SHOWN]]
    return " or ".join(lines)
