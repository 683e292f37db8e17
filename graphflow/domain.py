"""The domain and the rendezvous of a process, from its environment."""

from __future__ import annotations

import os

from graphflow.errors import GraphflowError

ENDPOINT_VARIABLE = "GRAPHFLOW_RENDEZVOUS"
"""The variable with the endpoint of the rendezvous."""
DEFAULT_ENDPOINT = "tcp/127.0.0.1:7447"
"""The router's endpoint in the default settings of ROS 2 nodes."""
DOMAIN_VARIABLES = ("GRAPHFLOW_DOMAIN", "ROS_DOMAIN_ID")


def domain_id(given: int | None = None) -> int:
    """Return the domain to use: the given one, else GRAPHFLOW_DOMAIN, else ROS_DOMAIN_ID, else 0.

    Raises:
        GraphflowError: A variable is not a whole number, 0 or more.
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
    """Return the variable that determines the domain of processes started from this process's shell."""
    return next((name for name in DOMAIN_VARIABLES if os.environ.get(name, "").strip()), DOMAIN_VARIABLES[0])


def rendezvous_endpoint() -> str:
    """Return the endpoint at which processes of this machine find each other."""
    return os.environ.get(ENDPOINT_VARIABLE, DEFAULT_ENDPOINT)


def go_to(domain: int, endpoint: str) -> None:
    """Set the domain and the rendezvous of sessions and processes that this process opens from now on."""
    os.environ[DOMAIN_VARIABLES[0]], os.environ[ENDPOINT_VARIABLE] = str(domain), endpoint
