"""Hashes of types."""

from rclpy.type_hash import TypeHash


def test_it_shows_itself_as_on_the_wire() -> None:
    """Unless it is none."""
    assert str(TypeHash()) == "INVALID"
    known = TypeHash(1, bytes(range(32)))
    assert str(known).startswith("RIHS01_000102")
    assert known == TypeHash(1, bytes(range(32)))
    assert known != TypeHash()
    assert len({known, TypeHash(1, bytes(range(32)))}) == 1
