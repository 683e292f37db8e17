"""Numbers on the command line that are given with a unit."""

from __future__ import annotations

import pytest

from graphflow.cli.numbers import plain_words

SECONDS, BYTES = "Seconds to record. --duration", "Bytes after which a new file begins. -b"


@pytest.mark.parametrize(
    ("text", "kind", "about", "told"),
    [
        ("500ms", "float", SECONDS, "'500ms' is not a number; write 0.5, as it is in seconds"),
        ("2min", "float range", SECONDS, "'2min' is not a number; write 120, as it is in seconds"),
        ("5s", "float range", SECONDS, "'5s' is not a number; write 5"),
        ("1,5", "float", SECONDS, "'1,5' is not a number; write 1.5"),
        ("2Hz", "float", SECONDS, "'2Hz' is not a number."),
        ("soon", "float", SECONDS, "'soon' is not a number."),
        ("10MB", "integer range", BYTES, "'10MB' is not a whole number; write 10000000, as it is in bytes"),
        ("1.5kB", "integer range", BYTES, "'1.5kB' is not a whole number; write 1500, as it is in bytes"),
        ("10x", "integer range", BYTES, "'10x' is not a whole number; write 10"),
        ("1.5", "integer", "Messages to average.", "'1.5' is not a whole number."),
        ("10hz", "float", "Rate in Hz.", "'10hz' is not a number; write 10"),
        ("1khz", "float", "Rate in Hz.", "'1khz' is not a number; write 1000, as it is in Hz"),
        ("100ms", "float", "Rate in Hz.", "'100ms' is not a number."),
        (
            "5s",
            "integer range",
            "The same in nanoseconds.",
            "'5s' is not a whole number; write 5000000000, as it is in nanoseconds",
        ),
        ("2x", "float", "Speed factor.", "'2x' is not a number; write 2"),
        ("7s", "float", "Lease. --qos-lease-duration-seconds", "'7s' is not a number; write 7"),
    ],
)
def test_what_is_meant(text: str, kind: str, about: str, told: str) -> None:
    """It is converted to what the option counts; a number in another quantity is not suggested."""
    assert plain_words(f"'{text}' is not a valid {kind}.", about) == told


def test_other_messages() -> None:
    """They are left as they are."""
    assert plain_words("-1.0 is not in the range x>=0.", SECONDS) == "-1.0 is not in the range x>=0."
