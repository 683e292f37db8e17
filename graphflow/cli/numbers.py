"""Numbers on the command line that are given with a unit: `500ms` where seconds are wanted, `10MB` for bytes."""

from __future__ import annotations

import re
from collections.abc import Mapping

from graphflow.times import SECONDS

_NO_NUMBER = re.compile(r"'([^']*)' is not a valid (float|integer)(?: range)?\.")
"""Click's message about an invalid number."""
_NUMBER = re.compile(r"([-+]?\d+(?:[.,]\d+)?)\s*(.*)")
"""The number that a text may begin with, as `10hz` does."""
_BYTES = {"b": 1, "k": 10**3, "kb": 10**3, "kib": 2**10, "m": 10**6, "mb": 10**6, "mib": 2**20, "g": 10**9, "gb": 10**9}
_UNITS: Mapping[str, Mapping[str, float]] = {
    "nanoseconds": {unit: seconds * 1e9 for unit, seconds in SECONDS.items()},
    "seconds": SECONDS,
    "bytes": {**_BYTES, "gib": 2**30},
    "Hz": {"hz": 1, "khz": 10**3, "mhz": 10**6},
}
"""Units by what an option counts, as its help text says."""


def plain_words(message: str, about: str) -> str:
    """Return a message of click's with plain words and the number that was meant, if it is about an invalid number.

    Args:
        about: The help text and names of the option, which say what the number counts.
    """
    return _NO_NUMBER.sub(lambda found: _wanted(found[1], about, is_whole=found[2] == "integer"), message)


def _wanted(text: str, about: str, *, is_whole: bool) -> str:
    meant = _meant(text, about)
    if is_whole and "." in meant.partition(",")[0]:
        meant = ""
    return f"{text!r} is not a {'whole ' if is_whole else ''}number{f'; write {meant}' if meant else '.'}"


def _meant(text: str, about: str) -> str:
    """Return the number to write, and what it counts if that was given in another unit; empty if it is not known."""
    found = _NUMBER.match(text)
    if found is None:
        return ""
    number, unit = found[1].replace(",", "."), found[2].strip().lower()
    counted = next((word for word in _UNITS if re.search(rf"\b{word}\b", about, re.IGNORECASE)), "")
    if not counted or not any(unit in units for units in _UNITS.values()):
        return number
    factor = _UNITS[counted].get(unit)
    if factor is None or factor == 1:
        return "" if factor is None else number
    return f"{float(number) * factor:.9f}".rstrip("0").rstrip(".") + f", as it is in {counted}"
