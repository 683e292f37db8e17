"""GIDs."""

from __future__ import annotations

from graphflow.wire.gid import gid, gid_text


def test_gid_of_a_node_token() -> None:
    """A token's GID is the one upstream computes; more tokens are in test_liveliness."""
    token = "@ros2_lv/0/aac3178e146ba6f1fc6e6a4085e77f21/0/0/NN/%/%/listener"
    assert gid(token).hex() == "5bd72f4daf53c0bb00c7394e7fc19547"


def test_low_half_comes_first() -> None:
    """The published XXH3-128 of no bytes is stored low 64 bits first, each half little-endian."""
    high, low = 0x99AA06D3014798D8, 0x6001C324468D497F
    assert gid("") == low.to_bytes(8, "little") + high.to_bytes(8, "little")


def test_text_is_that_of_the_command_line() -> None:
    """A GID is printed as hexadecimal bytes with points between."""
    assert gid_text(bytes(range(0, 256, 17))) == "00.11.22.33.44.55.66.77.88.99.aa.bb.cc.dd.ee.ff"
