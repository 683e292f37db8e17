"""What to say where a listing is empty: where else something runs."""

from __future__ import annotations

from collections import Counter

from graphflow.domain import domain_id
from graphflow.names import is_hidden
from graphflow.transport.client import Client
from graphflow.wire.liveliness import ADMIN_SPACE, Kind, parse_token


def nothing_here(what: str) -> str:
    """`no nodes in domain 5; there are 3 nodes in domain 0: graphflow --domain 0 ...`.

    Args:
        what: What is missing: `no topics`.
    """
    here = domain_id()
    client = Client()
    try:
        found = [parse_token(token) for token in client.tokens(f"{ADMIN_SPACE}/**")]
    finally:
        client.close()
    visible = [e.domain for e in found if e is not None and e.kind is Kind.NODE and not is_hidden(e.node)]
    others = Counter(domain for domain in visible if domain != here)
    if not others:
        return f"{what} in domain {here}, and none in others"
    listing = ", ".join(f"{n} node{'s' if n > 1 else ''} in domain {d}" for d, n in sorted(others.items())[:5])
    return f"{what} in domain {here}; there are {listing}: graphflow --domain {min(others)} ..."
