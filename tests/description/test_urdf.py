"""Robot descriptions: what joints do, and each mistake at its line."""

from __future__ import annotations

import math

import pytest

from graphflow.description import Robot, parse, urdf
from graphflow.errors import GraphFileError

LINKS = '<link name="base"/><link name="arm"/>'
LIMIT = '<limit lower="-1" upper="2" effort="1" velocity="1"/>'


def joint(type_: str = "continuous", more: str = "", name: str = "j", parent: str = "base", child: str = "arm") -> str:
    limit = LIMIT if type_ in urdf.NEEDS_LIMIT and "<limit" not in more else ""
    return f'<joint name="{name}" type="{type_}"><parent link="{parent}"/><child link="{child}"/>{more}{limit}</joint>'


def robot(text: str) -> Robot:
    return parse(f"<robot name='r'>\n{text}</robot>", "r.urdf")


def test_a_joint_moves_its_child() -> None:
    """Around its axis or along it, from its origin on; a fixed one does not."""
    origin = '<origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>'
    turned = robot(LINKS + joint("revolute", f'{origin}<axis xyz="0 0 2"/>')).joints["j"].pose(math.pi / 2)
    assert turned.translation == (1.0, 0.0, 0.0)
    assert turned.rotation == pytest.approx((0, 0, 1, 0))
    slid = robot(LINKS + joint("prismatic", origin)).joints["j"].pose(2.0)
    assert slid.translation == pytest.approx((1.0, 2.0, 0.0))
    fixed = robot(LINKS + joint("fixed", '<origin rpy="3.141592653589793 0 0"/>')).joints["j"].pose(5.0)
    assert fixed.rotation == pytest.approx((1, 0, 0, 0))


def test_joints_that_mimic_others() -> None:
    """They follow those whose position is given; a joint starts at 0, or in the middle of its limits."""
    second = joint("prismatic", '<mimic joint="j" multiplier="2" offset="0.5"/>', "k", "arm", "hand")
    made = robot(LINKS + '<link name="hand"/>' + joint() + second)
    assert [(j.name, position) for j, position in made.moved({"j": 0.25, "other": 3.0})] == [("j", 0.25), ("k", 1.0)]
    assert made.root == "base"
    assert made.joints["k"].home == 0.0
    far = joint("revolute", '<limit lower="1" upper="2"/>')
    assert robot(LINKS + far).joints["j"].home == 1.5


def test_shapes() -> None:
    """Boxes, cylinders, spheres and meshes, with their colours, also those that have a name elsewhere."""
    looks = [
        '<geometry><box size="1 2 3"/></geometry><material name="red"/>',
        '<origin xyz="0 0 1"/><geometry><cylinder radius="0.5" length="2"/></geometry>',
        '<geometry><sphere radius="0.1"/></geometry><material name=""><color rgba="0 1 0 0.5"/></material>',
        '<geometry><mesh filename="package://p/m.stl" scale="0.001 0.001 0.001"/></geometry>',
    ]
    visuals = "".join(f"<visual>{look}</visual>" for look in looks)
    made = robot(f'<link name="a">{visuals}</link><material name="red"><color rgba="1 0 0 1"/></material>')
    box, cylinder, sphere, mesh = made.links["a"].visuals
    assert (box.kind, box.size, box.colour) == ("box", (1, 2, 3), (1, 0, 0, 1))
    assert (cylinder.size, cylinder.origin.translation, cylinder.colour) == ((0.5, 2), (0, 0, 1), None)
    assert (sphere.size, sphere.colour) == ((0.1,), (0, 1, 0, 0.5))
    assert (mesh.mesh, mesh.size) == ("package://p/m.stl", (0.001, 0.001, 0.001))


MISTAKES = {
    "<link": "r.urdf:2:6: not valid XML: not well-formed",
    "": "r.urdf:1:1: the robot has no link",
    "<link/>": "r.urdf:2:1: a <link> has no name",
    "<lnk name='a'/>": "r.urdf:2:1: unknown element <lnk>; did you mean <link>?",
    "<xacro:include filename='x'/>" + LINKS + joint(): "r.urdf:2:1: <xacro:include> is of xacro, which expands files",
    LINKS: "r.urdf:1:1: the links are not one tree: base, arm have no parent; a joint must join them",
    LINKS + LINKS: "there are two links 'base'",
    LINKS + joint(child="amr"): "the child of the joint 'j' is 'amr', which is no link; did you mean 'arm'?",
    LINKS + joint() + joint(): "there are two joints 'j'",
    LINKS + joint() + joint(name="k"): "the link 'arm' has two parent joints: j, k",
    LINKS + joint() + joint(name="k", parent="arm", child="base"): "the links have no root: the joints form a cycle",
    LINKS
    + '<link name="c"/>'
    + joint("fixed", name="k", parent="arm", child="c")
    + joint("fixed", name="l", parent="c", child="arm"): "the joints between arm, c form a cycle",
    LINKS + joint("revolut"): "the joint 'j' is of no known type: 'revolut'; did you mean 'revolute'?",
    LINKS + joint("springy"): "of no known type: 'springy'; ",
    LINKS + joint("revolute").replace(LIMIT, ""): "the joint 'j' needs limits: <limit lower",
    LINKS
    + joint("revolute", '<limit lower="2" upper="1"/>'): "the lower limit 2 of the joint 'j' is above the upper 1",
    LINKS + joint(more='<axis xyz="0 0 0"/>'): "the axis of the joint 'j' has no direction",
    LINKS + joint(more='\n<origin xyz="1 2"/>'): 'r.urdf:3:1: xyz="1 2": expected three numbers',
    LINKS + joint(more='\n<origin xyz="1 2 z"/>'): "r.urdf:3:1: 'z' is not a number",
    LINKS + joint(more='<origin xyz="0 0 ${h}"/>'): "'${h}' is not a number; $(...) and ${...} are of xacro: give the",
    LINKS + joint(more='<origin xyz="1 2 nan"/>'): "'nan' is not finite",
    LINKS + joint(more='<mimic joint="k"/>'): "the joint 'j' mimics 'k', which is none",
    LINKS + '<joint name="j" type="fixed"><child link="arm"/></joint>': "the joint 'j' has no parent link",
    '<link name="a"><visual/></link>': "a visual has one <geometry> with a box, cylinder, sphere or mesh",
    '<link name="a"><visual><geometry><bx/></geometry></visual></link>': "unknown geometry <bx>; did you mean 'box'?",
    '<link name="a"><visual><geometry><box/></geometry></visual></link>': "a <box> has a size",
    '<link name="a"><visual><geometry><sphere/></geometry></visual></link>': "a <sphere> has a radius",
    '<link name="a"><visual><geometry><mesh/></geometry></visual></link>': "a mesh has a filename",
    '<link name="a"/><material name="m"><color rgba="1 0"/></material>': 'rgba="1 0": expected four numbers',
}


@pytest.mark.parametrize("text", MISTAKES)
def test_mistakes(text: str) -> None:
    """The error has the line, and what is right."""
    with pytest.raises(GraphFileError) as caught:
        robot(text)
    assert MISTAKES[text] in str(caught.value)


def test_all_mistakes_come_together() -> None:
    """In the order of the file."""
    with pytest.raises(GraphFileError) as caught:
        robot('<link name="a"/>\n<link name="a"/>\n<joint name="j" type="x"><parent link="q"/></joint>')
    lines = str(caught.value).splitlines()
    assert [line.split(": ")[0] for line in lines] == ["r.urdf:3:1", "r.urdf:4:1", "r.urdf:4:1", "r.urdf:4:26"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("arm.urdf", r"'arm.urdf' is the name of a file, not its text: write file:=arm.urdf, or its text"),
        ("<sdf/>", "the root element is <sdf>, not <robot>"),
        ('<!DOCTYPE r [<!ENTITY a "b">]><robot/>', "a document type is not read"),
        ("<robot>" + "<a>" * 200 + "</a>" * 200 + "</robot>", "elements nested too deeply"),
    ],
)
def test_what_is_refused(text: str, said: str) -> None:
    """Other formats, entities, and what is nested without end."""
    with pytest.raises(GraphFileError, match=said):
        parse(text)


def test_the_number_of_elements_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """A description with too many is refused while it is read."""
    monkeypatch.setattr(urdf, "ELEMENTS_BOUND", 5)
    with pytest.raises(GraphFileError, match="more than 5 elements"):
        parse("<robot>" + '<link name="a"/>' * 9 + "</robot>")


@pytest.mark.parametrize(
    ("origin", "told"),
    [
        ('rpy="0 0 90"', "rpy is in radians, and has 90; 90 degrees are 1.571"),
        ('xyz="0 -250 0"', "xyz is in metres, and has -250; -250 mm are -0.25"),
        ('xyz="0 0 1" rpy="0 0 3.1416"', ""),
    ],
)
def test_origins_in_other_units(origin: str, told: str) -> None:
    """They are read as they are, with a remark."""
    joint = f'<joint name="j" type="fixed"><parent link="a"/><child link="b"/><origin {origin}/></joint>'
    found = robot(f'<link name="a"/>\n<link name="b"/>\n{joint}').remarks
    assert [text.partition(": ")[2] for text in found] == ([told] if told else [])
