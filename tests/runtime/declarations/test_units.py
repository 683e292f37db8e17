"""Units of parameters that contradict their use."""

from __future__ import annotations

import pytest

from graphflow import DeclarationError, Node, Param, timer


def _made(parameter: Param[float], *, is_hz: bool) -> type[Node]:
    class Robot(Node):
        rate = parameter

        @timer(hz=rate) if is_hz else timer(rate)
        def tick(self) -> None: ...

    return Robot


@pytest.mark.parametrize(
    ("value", "unit", "is_hz", "told"),
    [
        (10.0, "Hz", False, "a period is in seconds, and the parameter 'rate' is in Hz; write @timer(hz=rate)"),
        (0.5, "s", True, "hz= is in Hz, and the parameter 'rate' is in s; write @timer(rate)"),
        (
            *(100.0, "ms", False),
            "a period is in seconds, and the parameter 'rate' is in ms; write rate = Param(0.1, unit=\"s\")",
        ),
        (
            *(100.0, "ms", True),
            "hz= is in Hz, and the parameter 'rate' is in ms; write rate = Param(0.1, unit=\"s\") and @timer(rate)",
        ),
        (
            *(2.0, "kHz", False),
            "a period is in seconds, and the parameter 'rate' is in kHz; write rate = Param(2000.0, unit=\"Hz\") and "
            "@timer(hz=rate)",
        ),
        (60.0, "rpm", True, "hz= is in Hz, and the parameter 'rate' is in rpm; write rate = Param(1.0, unit=\"Hz\")"),
    ],
)
def test_a_unit_that_is_not_that_of_the_timer(value: float, unit: str, is_hz: bool, told: str) -> None:
    """Is refused with the line of the timer and the right form."""
    with pytest.raises(DeclarationError) as raised:
        _made(Param(value, unit=unit), is_hz=is_hz)
    assert str(raised.value).endswith(f": @timer: {told}")


@pytest.mark.parametrize(
    ("unit", "is_hz"),
    [("s", False), ("seconds", False), ("", False), ("", True), ("Hz", True), ("1/s", True), ("ticks", False)],
)
def test_a_unit_that_fits_or_is_unknown(unit: str, is_hz: bool) -> None:
    """Is accepted."""
    assert _made(Param(2.0, unit=unit), is_hz=is_hz).interface().params
