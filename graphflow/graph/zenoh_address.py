"""The addresses of Zenoh endpoints."""

from __future__ import annotations

PROTOCOLS = ("tcp", "tls")


def endpoint(text: str) -> str:
    """Check the form of `tcp/HOST:PORT` or `tls/HOST:PORT`.

    Raises:
        ValueError: `text` has another form.
    """
    protocol, _, rest = text.partition("/")
    host, _, port = rest.rpartition(":")
    if protocol not in PROTOCOLS or not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise ValueError(f"{text!r} is not an endpoint; {port_fault(port) or 'write tcp/HOST:7447 or tls/HOST:7447'}")
    return text


def port_fault(port: str) -> str:
    """Return the fault of a port number that is out of range; empty for a valid one, or one that is no number."""
    return f"a port is 1 to 65535, not {port}" if port.isdecimal() and not 0 < int(port) < 65536 else ""
