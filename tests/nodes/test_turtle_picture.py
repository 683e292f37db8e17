"""A picture of the turtles."""

from xml.etree import ElementTree

import pytest

from nodes.turtle_canvas import Pen
from nodes.turtle_picture import COATS, svg
from nodes.turtle_world import SIZE, World

SVG = "{http://www.w3.org/2000/svg}"


def draw(world: World) -> ElementTree.Element:
    """The picture of a world as XML."""
    return ElementTree.fromstring(svg(world, (69, 86, 255)))


def test_an_empty_world_is_its_background() -> None:
    """500 x 500 pixels of one colour."""
    picture = draw(World())

    assert picture.tag == f"{SVG}svg"
    assert (picture.get("width"), picture.get("height"), picture.get("viewBox")) == ("500", "500", "0 0 500 500")
    rect = picture.find(f"{SVG}rect")
    assert rect is not None
    assert rect.get("fill") == "#4556ff"
    assert picture.findall(f".//{SVG}title") == []


def test_strokes_have_their_pens_and_corners() -> None:
    """A stroke from corner to corner: x goes right, y goes up, pixel middles are at halves."""
    world = World()
    world.canvas.draw("t", Pen((255, 128, 0), 7), (0.0, 0.0), (SIZE, SIZE))

    (line,) = draw(world).iter(f"{SVG}polyline")

    assert line.get("points") == "0.5,499.5 499.5,0.5"
    assert (line.get("stroke"), line.get("stroke-width")) == ("#ff8000", "7")


def test_turtles_are_where_they_are_and_named() -> None:
    """Rotated against the clock, since theta is; each in a coat of its own, until there are no more."""
    world = World()
    for i in range(len(COATS) + 1):
        world.spawn(f"t{i}", 5.0, 6.0, 0.5)

    groups = [g for g in draw(world) if g.find(f"{SVG}title") is not None]

    assert [g.findtext(f"{SVG}title") for g in groups] == [f"t{i}" for i in range(len(COATS) + 1)]
    assert {g.get("transform") for g in groups} == {"translate(225.5 229.5) rotate(-28.6)"}
    bodies = [ElementTree.tostring(g[1]) for g in groups]
    assert len(set(bodies)) == len(COATS)
    assert bodies[0] == bodies[-1]


@pytest.mark.parametrize("name", ["<&>", 'a"b', "schildkröte"])
def test_any_name_makes_valid_xml(name: str) -> None:
    """The world accepts names that no topic can have."""
    world = World()
    world.spawn(name, 1.0, 1.0, 0.0)

    assert draw(world).findtext(f".//{SVG}title") == name
