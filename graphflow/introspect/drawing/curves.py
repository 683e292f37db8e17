"""Numbers of messages over time, drawn as curves in a terminal."""

from __future__ import annotations

import math
from array import array
from bisect import bisect_left
from collections.abc import Sequence
from typing import TYPE_CHECKING

from graphflow.introspect.messages.fields import number_path, value_at
from graphflow.introspect.messages.units import unit

if TYPE_CHECKING:
    from graphflow.msgs.base import Message

CURVES = 6
"""Most curves in a picture, unless fields are named."""
LARGEST = 1e150
"""Largest value that is drawn; larger ones commonly stand for "no measurement"."""
COLOURS = ("#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#f0e442", "#d55e00")
"""Colours that colour-blind people can distinguish, too (Okabe and Ito 2008)."""


class Curve:
    """One field of a topic over time.

    Args:
        field: Its path: `linear.x`.
        type_name: The topic's type.
        label: Its name in the picture.

    Raises:
        UsageFault: The type has no such field, or it is not a number.
    """

    def __init__(self, field: str, type_name: str, label: str = "") -> None:
        self.label = label or field
        self.times = array("d")
        """Seconds."""
        self.values = array("d")
        self._path = number_path(field, type_name)
        self.unit = unit(self._path, type_name)
        """Such as `m/s`; empty if the message's definition gives none."""

    def add(self, at: float, message: Message) -> None:
        """Append a message's value; a missing element or one that is not a number is a gap."""
        try:
            value = float(value_at(message, self._path))
        except (IndexError, TypeError, ValueError):
            value = math.nan
        self.times.append(at)
        self.values.append(value)

    def forget(self, before: float) -> None:
        """Drop values older than `before`."""
        cut = bisect_left(self.times, before)
        del self.times[:cut]
        del self.values[:cut]

    @property
    def is_empty(self) -> bool:
        """Whether it has no value that can be drawn."""
        return not any(abs(y) <= LARGEST for y in self.values)

    def shown(self, since: float = -math.inf) -> tuple[list[float], list[float]]:
        """Return the times and values from a moment on, without NaN and values beyond `LARGEST`."""
        start = bisect_left(self.times, since)
        points = zip(self.times[start:], self.values[start:], strict=True)
        found = [(x, y) for x, y in points if abs(y) <= LARGEST]
        return [x for x, _ in found], [y for _, y in found]

    @property
    def legend(self) -> str:
        """The curve's name, last value and unit."""
        return f"{self.label} {self.values[-1]:.4g} {self.unit}".rstrip() if self.values else f"{self.label} -"


def chart(
    curves: Sequence[Curve],
    size: tuple[int, int],
    *,
    span: tuple[float, float] | None = None,
    colours: Sequence[str] = (),
    legend: bool = True,
) -> str:
    """Draw curves with Braille characters, as lines of text with the escape sequences of their colours.

    Args:
        size: Columns and rows of the picture.
        span: The first and last second on the axis, by default those of the data; the last one is labelled 0.
        colours: One `#rrggbb` for each curve; none for a picture without colours.
        legend: Whether the names and last values of the curves are printed below.

    Returns:
        The text; empty if there is no value.
    """
    end = span[1] if span else 0.0
    drawn = [curve.shown(span[0]) if span else curve.shown() for curve in curves]
    picked = [i for i, (xs, _) in enumerate(drawn) if xs]
    if not picked:
        return ""
    from uniplot import plot_to_string

    low, high = _margins([y for i in picked for y in drawn[i][1]])
    width, height = size
    limits = {"x_min": span[0] - end, "x_max": 0.0} if span else {}
    text: str = plot_to_string(
        xs=[[x - end for x in drawn[i][0]] for i in picked],
        ys=[drawn[i][1] for i in picked],
        lines=True,
        character_set="braille",
        color=[colours[i % len(colours)] for i in picked] if colours else False,
        width=max(10, width - _SIDE),
        height=max(3, height - (5 if legend else 3)),
        x_unit=" s",
        y_min=low,
        y_max=high,
        legend_labels=[curves[i].legend for i in picked] if legend else None,
        **limits,
    )
    return text.rstrip("\n")


_SIDE = 12
"""Columns of the frame and the numbers beside it."""


def _margins(values: Sequence[float]) -> tuple[float, float]:
    low, high = min(values), max(values)
    margin = (high - low) * 0.05 or max(abs(high) * 0.1, 1e-3)
    return low - margin, high + margin
