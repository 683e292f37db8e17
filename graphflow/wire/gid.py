"""An entity's GID: the XXH3 128-bit hash of its liveliness token, as rmw_zenoh stores it."""

from __future__ import annotations

import xxhash


def gid(token: str) -> bytes:
    """Return the GID's 16 bytes: the low 64 bits of the hash little-endian, then the high 64 bits."""
    # The digest is big-endian, high half first: reversed, it is the low half, then the high half, both little-endian.
    return xxhash.xxh3_128_digest(token.encode())[::-1]


def gid_text(value: bytes) -> str:
    """Format a GID as `ros2 topic info -v` does: `01.0f.44...`."""
    return ".".join(f"{b:02x}" for b in value)
