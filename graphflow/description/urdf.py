"""The XML of robot descriptions, with each mistake at its line. Source: the URDF reference, `link` and `joint`."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from graphflow.description.robot import MOVES, Joint, Link, Mimic, Robot, Shape
from graphflow.errors import GraphFileError, Place, Problem
from graphflow.names import did_you_mean, nearest
from graphflow.tf.poses import Pose, Vector, from_rpy

TYPES = (*sorted(MOVES), "fixed", "floating", "planar")
NEEDS_LIMIT = {"revolute", "prismatic"}
TOP = ("link", "joint", "material", "transmission", "gazebo", "sensor", "ros2_control", "group", "origin")
"""Elements of a robot; others that resemble none of these are left out, as ROS does."""
DEPTH_BOUND = 100
"""The nesting of elements, at most."""
ELEMENTS_BOUND = 100_000
Colour = tuple[float, float, float, float]

TURNS, FAR = 10.0, 50.0
"""Radians and metres of an origin beyond which they are probably degrees and millimetres."""


@dataclass(slots=True)
class _Element:
    """An XML element with its place."""

    tag: str
    attributes: dict[str, str]
    place: Place
    children: list[_Element] = field(default_factory=list)

    def all(self, tag: str) -> Iterator[_Element]:
        return (child for child in self.children if child.tag == tag)

    def first(self, tag: str) -> _Element | None:
        return next(self.all(tag), None)


def parse(text: str, name: str = "robot_description") -> Robot:
    """Parse a description.

    Args:
        name: The file as messages show it.

    Raises:
        GraphFileError: The text is not a robot description; all mistakes, with their places.
    """
    if "<" not in text and (file := text.strip()).endswith((".urdf", ".xacro", ".xml")):
        way = f'write file:={file}, or its text, as in robot_description:="$(cat {file})"'
        raise GraphFileError([Problem(Place(name, 1, 1), f"{file!r} is the name of a file, not its text: {way}")])
    return _Reader().read(_tree(text, name))


def _tree(text: str, name: str) -> _Element:
    parser = expat.ParserCreate()
    open_: list[_Element] = []
    top: list[_Element] = []
    count = 0

    def begin(tag: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        place = Place(name, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
        if count > ELEMENTS_BOUND or len(open_) >= DEPTH_BOUND:
            what = f"more than {ELEMENTS_BOUND:,} elements" if count > ELEMENTS_BOUND else "elements nested too deeply"
            raise GraphFileError([Problem(place, f"a robot description has {what}")])
        element = _Element(tag, attributes, place)
        (open_[-1].children if open_ else top).append(element)
        open_.append(element)

    def refuse(*_: object) -> None:
        place = Place(name, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
        raise GraphFileError([Problem(place, "a document type is not read: remove <!DOCTYPE ...>")])

    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda _: open_.pop()
    parser.StartDoctypeDeclHandler = refuse  # entities are declared there, by which a small file could grow without end
    try:
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        place = Place(name, error.lineno, error.offset + 1)
        raise GraphFileError([Problem(place, f"not valid XML: {expat.ErrorString(error.code)}")]) from None
    return top[0]


class _Reader:
    """The elements of a description as a robot; collects the mistakes."""

    def __init__(self) -> None:
        self._problems: list[Problem] = []
        self._remarks: list[str] = []
        self._materials: dict[str, Colour] = {}

    def _fault(self, element: _Element, text: str) -> None:
        self._problems.append(Problem(element.place, text))

    def read(self, top: _Element) -> Robot:
        if top.tag != "robot":
            self._fault(top, f"the root element is <{top.tag}>, not <robot>")
            raise GraphFileError(self._problems)
        for child in top.children:
            self._check_tag(child)
        for material in top.all("material"):
            colour = self._colour(material)
            if colour is not None:
                self._materials[self._name(material)] = colour
        links = self._links(top)
        joints, places = self._joints(top, links)
        if not self._problems:
            self._check_tree(top, links, joints, places)
        if self._problems:
            raise GraphFileError(self._problems)
        return Robot(top.attributes.get("name", ""), links, joints, tuple(self._remarks))

    def _check_tag(self, child: _Element) -> None:
        meant = nearest(child.tag, TOP) if child.tag not in TOP and ":" not in child.tag else None
        if meant is not None:
            self._fault(child, f"unknown element <{child.tag}>; did you mean <{meant}>?")
        elif child.tag.startswith("xacro:"):
            self._fault(child, f"<{child.tag}> is of xacro, which expands files: -p file:=PATH")

    def _links(self, top: _Element) -> dict[str, Link]:
        links: dict[str, Link] = {}
        for element in top.all("link"):
            link = Link(self._name(element), [self._shape(visual) for visual in element.all("visual")])
            if link.name in links:
                self._fault(element, f"there are two links {link.name!r}")
            links[link.name] = link
        if not links:
            self._fault(top, "the robot has no link")
        return links

    def _joints(self, top: _Element, links: dict[str, Link]) -> tuple[dict[str, Joint], dict[str, _Element]]:
        """Return the joints and their elements, by name."""
        joints: dict[str, Joint] = {}
        places: dict[str, _Element] = {}
        for element in top.all("joint"):
            joint = self._joint(element, links)
            if joint.name in joints:
                self._fault(element, f"there are two joints {joint.name!r}")
            joints[joint.name], places[joint.name] = joint, element
        for joint in joints.values():
            if joint.mimic is not None and joint.mimic.joint not in joints:
                near = did_you_mean(joint.mimic.joint, joints)
                text = f"the joint {joint.name!r} mimics {joint.mimic.joint!r}, which is none{near}"
                self._fault(places[joint.name], text)
        return joints, places

    def _check_tree(
        self, top: _Element, links: dict[str, Link], joints: dict[str, Joint], places: dict[str, _Element]
    ) -> None:
        above: dict[str, Joint] = {}
        for joint in joints.values():
            if joint.child in above:
                other = above[joint.child].name
                self._fault(
                    places[joint.name], f"the link {joint.child!r} has two parent joints: {other}, {joint.name}"
                )
            above[joint.child] = joint
        roots = [link for link in links if link not in above]
        if self._problems:
            return
        if not roots:
            self._fault(top, "the links have no root: the joints form a cycle")
        elif len(roots) > 1:
            named = ", ".join(roots[:10])
            self._fault(top, f"the links are not one tree: {named} have no parent; a joint must join them")
        else:
            self._check_reach(top, roots[0], links, joints)

    def _check_reach(self, top: _Element, root: str, links: dict[str, Link], joints: dict[str, Joint]) -> None:
        below: dict[str, list[str]] = {}
        for joint in joints.values():
            below.setdefault(joint.parent, []).append(joint.child)
        reached, ahead = set[str](), [root]
        while ahead:
            link = ahead.pop()
            reached.add(link)
            ahead += below.get(link, [])
        if len(reached) < len(links):
            lost = ", ".join(link for link in links if link not in reached)
            self._fault(top, f"the joints between {lost} form a cycle")

    def _joint(self, element: _Element, links: dict[str, Link]) -> Joint:
        name, type_ = self._name(element), element.attributes.get("type", "")
        if type_ not in TYPES:
            told = did_you_mean(type_, TYPES) or f"; the types are {', '.join(TYPES)}"
            self._fault(element, f"the joint {name!r} is of no known type: {type_!r}{told}")
        axis = self._numbers(element.first("axis"), "xyz", (1.0, 0.0, 0.0))
        length = math.hypot(*axis)
        if type_ in MOVES and length == 0.0:
            self._fault(element.first("axis") or element, f"the axis of the joint {name!r} has no direction")
        x, y, z = (part / (length or 1.0) for part in axis)
        parent, child = (self._end(element, name, end, links) for end in ("parent", "child"))
        return Joint(
            name,
            type_,
            parent,
            child,
            self._origin(element),
            (x, y, z),
            self._mimic(element),
            self._limits(element, name),
        )

    def _end(self, joint: _Element, name: str, end: str, links: dict[str, Link]) -> str:
        element = joint.first(end)
        link = "" if element is None else element.attributes.get("link", "")
        if element is None or not link:
            self._fault(element or joint, f"the joint {name!r} has no {end} link")
        elif link not in links:
            self._fault(
                element, f"the {end} of the joint {name!r} is {link!r}, which is no link{did_you_mean(link, links)}"
            )
        return link

    def _mimic(self, joint: _Element) -> Mimic | None:
        element = joint.first("mimic")
        if element is None:
            return None
        factor, offset = (self._number(element, key, value) for key, value in (("multiplier", 1.0), ("offset", 0.0)))
        return Mimic(element.attributes.get("joint", ""), factor, offset)

    def _limits(self, joint: _Element, name: str) -> tuple[float, float] | None:
        element = joint.first("limit")
        if joint.attributes.get("type") not in NEEDS_LIMIT:
            return None
        if element is None:
            self._fault(
                joint, f'the joint {name!r} needs limits: <limit lower="-1" upper="1" effort="1" velocity="1"/>'
            )
            return None
        lower, upper = self._number(element, "lower", 0.0), self._number(element, "upper", 0.0)
        if lower > upper:
            self._fault(element, f"the lower limit {lower:g} of the joint {name!r} is above the upper {upper:g}")
        return lower, upper

    def _shape(self, visual: _Element) -> Shape:
        geometry = visual.first("geometry")
        shapes = geometry.children if geometry is not None else []
        if len(shapes) != 1:
            self._fault(geometry or visual, "a visual has one <geometry> with a box, cylinder, sphere or mesh")
            return Shape("sphere", (0.0,), "", self._origin(visual), None)
        shape = shapes[0]
        size: tuple[float, ...] = ()
        match shape.tag:
            case "box":
                size = self._numbers(shape, "size", None)
            case "cylinder":
                size = self._number(shape, "radius"), self._number(shape, "length")
            case "sphere":
                size = (self._number(shape, "radius"),)
            case "mesh":
                size = self._numbers(shape, "scale", (1.0, 1.0, 1.0))
                if not shape.attributes.get("filename"):
                    self._fault(shape, "a mesh has a filename")
            case _:
                near = did_you_mean(shape.tag, ("box", "cylinder", "sphere", "mesh"))
                self._fault(shape, f"unknown geometry <{shape.tag}>{near}")
        mesh = shape.attributes.get("filename", "") if shape.tag == "mesh" else ""
        material = visual.first("material")
        colour = None
        if material is not None:
            colour = self._colour(material) or self._materials.get(material.attributes.get("name", ""))
        return Shape(shape.tag, size, mesh, self._origin(visual), colour)

    def _colour(self, material: _Element) -> Colour | None:
        element = material.first("color")
        if element is None:
            return None
        words = element.attributes.get("rgba", "").split()
        numbers = [self._parsed(element, word) for word in words]
        if len(numbers) != 4:
            self._fault(element, f'rgba="{" ".join(words)}": expected four numbers from 0 to 1')
            return None
        return numbers[0], numbers[1], numbers[2], numbers[3]

    def _origin(self, element: _Element) -> Pose:
        origin = element.first("origin")
        place, turn = (self._numbers(origin, key, (0.0, 0.0, 0.0)) for key in ("xyz", "rpy"))
        far, turned = max(place, key=abs), max(turn, key=abs)
        if origin is not None and abs(turned) > TURNS:
            degrees = f"{turned:g} degrees are {math.radians(turned):.4g}"
            self._remarks.append(f"{origin.place}: rpy is in radians, and has {turned:g}; {degrees}")
        elif origin is not None and abs(far) > FAR:
            self._remarks.append(f"{origin.place}: xyz is in metres, and has {far:g}; {far:g} mm are {far / 1000:g}")
        return Pose(place, from_rpy(*turn))

    def _name(self, element: _Element) -> str:
        name = element.attributes.get("name", "")
        if not name:
            self._fault(element, f"a <{element.tag}> has no name")
        return name

    def _numbers(self, element: _Element | None, key: str, otherwise: Vector | None) -> Vector:
        text = None if element is None else element.attributes.get(key)
        if element is None or text is None:
            if otherwise is None and element is not None:
                self._fault(element, f"a <{element.tag}> has a {key}")
            return otherwise or (0.0, 0.0, 0.0)
        numbers = [self._parsed(element, word) for word in text.split()]
        if len(numbers) != 3:
            self._fault(element, f'{key}="{text}": expected three numbers')
            return otherwise or (0.0, 0.0, 0.0)
        return numbers[0], numbers[1], numbers[2]

    def _number(self, element: _Element, key: str, otherwise: float | None = None) -> float:
        text = element.attributes.get(key)
        if text is None:
            if otherwise is None:
                self._fault(element, f"a <{element.tag}> has a {key}")
            return otherwise or 0.0
        return self._parsed(element, text)

    def _parsed(self, element: _Element, text: str) -> float:
        try:
            number = float(text)
        except ValueError:
            hint = "; $(...) and ${...} are of xacro: give the file the ending .xacro" if "$" in text else ""
            self._fault(element, f"{text!r} is not a number{hint}")
            return 0.0
        if not math.isfinite(number):
            self._fault(element, f"{text!r} is not finite")
            return 0.0
        return number
