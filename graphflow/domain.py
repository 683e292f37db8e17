"""Where a process belongs: its domain, which keeps graphs on one network apart, and where its machine's nodes meet."""

from __future__ import annotations

import os

from graphflow.errors import GraphflowError

ENDPOINT_VARIABLE = "GRAPHFLOW_RENDEZVOUS"
"""Where the nodes of a machine meet."""
DEFAULT_ENDPOINT = "tcp/127.0.0.1:7447"
"""Where a ROS 2 node with default settings looks for its router."""
DOMAIN_VARIABLES = ("GRAPHFLOW_DOMAIN", "ROS_DOMAIN_ID")


def domain_id(given: int | None = None) -> int:
    """The domain to use: the given one, else GRAPHFLOW_DOMAIN, else ROS_DOMAIN_ID, else 0.

    Raises:
        GraphflowError: A variable holds something other than a whole number, 0 or more.
    """
    if given is not None:
        return given
    for variable in DOMAIN_VARIABLES:
        text = os.environ.get(variable, "").strip()
        if text:
            if not text.isdecimal():
                raise GraphflowError(f"{variable}={text!r}: a domain is a whole number, 0 or more")
            return int(text)
    return 0


def domain_variable() -> str:
    """The variable that decides about the domain of processes that this one's shell starts."""
    return next((name for name in DOMAIN_VARIABLES if os.environ.get(name, "").strip()), DOMAIN_VARIABLES[0])


def rendezvous_endpoint() -> str:
    """Where processes of this machine find each other."""
    return os.environ.get(ENDPOINT_VARIABLE, DEFAULT_ENDPOINT)


def go_to(domain: int, endpoint: str) -> None:
    """Have whatever this process opens or starts from now on meet in a domain, at an endpoint."""
    os.environ[DOMAIN_VARIABLES[0]], os.environ[ENDPOINT_VARIABLE] = str(domain), endpoint
