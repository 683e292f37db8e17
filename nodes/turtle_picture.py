"""A picture of the turtles and their drawing, as SVG, which any browser shows and any editor changes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from html import escape

from .turtle_canvas import PIXELS, Colour, Position, Stroke, to_pixel
from .turtle_world import Turtle, World

COATS = (
    ("#5fb04a", "#2f7d3b"),
    ("#e8a33d", "#b5651d"),
    ("#e06a6a", "#9c2f3f"),
    ("#57b8c9", "#23707f"),
    ("#b48ad8", "#6d4596"),
    ("#c9c14b", "#85802a"),
)
"""Colours of skin and shell for the first turtle, the second, and so on; repeated from the start."""

BODY = """
<g fill="{skin}" stroke="#1d2b1f" stroke-width="0.8" stroke-linejoin="round">
<path d="M-14 -2.6 L-22 0 L-14 2.6 Z"/>
<ellipse cx="11" cy="-12.5" rx="6.8" ry="3.6" transform="rotate(-52 11 -12.5)"/>
<ellipse cx="11" cy="12.5" rx="6.8" ry="3.6" transform="rotate(52 11 12.5)"/>
<ellipse cx="-10.5" cy="-11.5" rx="5.8" ry="3.3" transform="rotate(48 -10.5 -11.5)"/>
<ellipse cx="-10.5" cy="11.5" rx="5.8" ry="3.3" transform="rotate(-48 -10.5 11.5)"/>
<ellipse cx="18.5" cy="0" rx="6.2" ry="5"/>
</g>
<circle cx="20.6" cy="-2.4" r="1.1"/><circle cx="20.6" cy="2.4" r="1.1"/>
<g fill="{shell}" stroke="#1d2b1f" stroke-width="0.8" stroke-linejoin="round">
<ellipse cx="0" cy="0" rx="15.5" ry="13"/>
<path d="M7 0 L3.5 6 L-3.5 6 L-7 0 L-3.5 -6 L3.5 -6 Z M7 0 H15.5 M-7 0 H-15.5
M3.5 6 L6.5 11.8 M-3.5 6 L-6.5 11.8 M3.5 -6 L6.5 -11.8 M-3.5 -6 L-6.5 -11.8" stroke="{skin}" stroke-width="1.3"/>
</g>"""
"""A turtle seen from above, looking along x, one metre (45 pixels) from nose to tail."""


def svg(world: World, background: Colour) -> str:
    """Return the world as a picture of 500 x 500 pixels."""
    strokes = "\n".join(_stroke(stroke) for stroke in world.canvas.strokes)
    turtles = "\n".join(_turtle(turtle) for turtle in world.turtles.values())
    return f"""\
<svg xmlns="http://www.w3.org/2000/svg" width="{PIXELS}" height="{PIXELS}" viewBox="0 0 {PIXELS} {PIXELS}">
<rect width="{PIXELS}" height="{PIXELS}" fill="{_hex(background)}"/>
<g fill="none" stroke-linecap="round" stroke-linejoin="round">
{strokes}
</g>
{turtles}
</svg>
"""


def _stroke(stroke: Stroke) -> str:
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in _centres(stroke.points))
    return f'<polyline points="{points}" stroke="{_hex(stroke.pen.colour)}" stroke-width="{stroke.pen.width}"/>'


def _turtle(turtle: Turtle) -> str:
    skin, shell = COATS[turtle.number % len(COATS)]
    ((x, y),) = _centres([turtle.position])
    degrees = -math.degrees(turtle.theta)  # SVG's y goes down, and its angles turn clockwise
    body = BODY.format(skin=skin, shell=shell)
    place = f"translate({x:.1f} {y:.1f}) rotate({degrees:.1f})"
    return f'<g transform="{place}"><title>{escape(turtle.name)}</title>{body}</g>'


def _centres(positions: list[Position]) -> Iterator[Position]:
    """Return positions as SVG coordinates, where a pixel's centre is at a half."""
    return ((x + 0.5, y + 0.5) for x, y in map(to_pixel, positions))


def _hex(colour: Colour) -> str:
    return "#{:02x}{:02x}{:02x}".format(*colour)
