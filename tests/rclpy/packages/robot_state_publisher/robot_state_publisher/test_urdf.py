"""What is read of a robot's description."""

from __future__ import annotations

import math
from typing import Any

import pytest

pytestmark = pytest.mark.usefixtures("importable")

LINKS = '<link name="base"/><link name="arm"/>'


def joint(type_: str = "revolute", more: str = "", name: str = "j", parent: str = "base", child: str = "arm") -> str:
    return f'<joint name="{name}" type="{type_}"><parent link="{parent}"/><child link="{child}"/>{more}</joint>'


def parse(text: str) -> Any:
    from robot_state_publisher.urdf import parse

    return parse(f"<robot name='r'>{text}</robot>")


def test_a_joint_moves_its_child() -> None:
    """Around its axis or along it, from its origin on; fixed ones do not."""
    origin = '<origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>'
    turned = parse(LINKS + joint("revolute", f'{origin}<axis xyz="0 0 2"/>')).joints["j"].pose(math.pi / 2)
    assert turned.translation == (1.0, 0.0, 0.0)
    assert turned.rotation == pytest.approx((0, 0, 1, 0))
    slid = parse(LINKS + joint("prismatic", origin)).joints["j"].pose(2.0)
    assert slid.translation == pytest.approx((1.0, 2.0, 0.0))
    fixed = parse(LINKS + joint("fixed", '<origin rpy="3.141592653589793 0 0"/>')).joints["j"].pose(5.0)
    assert fixed.rotation == pytest.approx((1, 0, 0, 0))


def test_rotations_are_about_fixed_axes() -> None:
    """As transforms3d's 'sxyz', which is URDF's roll, pitch and yaw."""
    from tf_transformations import quaternion_from_euler

    found = parse(LINKS + joint("fixed", '<origin rpy="0.3 -1.1 2.5"/>')).joints["j"].origin
    assert found.rotation == pytest.approx(quaternion_from_euler(0.3, -1.1, 2.5))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("<link", "it is not XML"),
        ("", "it has no link"),
        ("<link/>", "a <link> has no name"),
        (LINKS, "several roots: base, arm"),
        (LINKS + joint(child="leg"), "the child of the joint 'j' is 'leg', which does not exist"),
        (LINKS + joint() + joint(), "there are two joints 'j'"),
        (LINKS + joint() + joint(name="k"), "the link 'arm' has two parent joints: j, k"),
        (LINKS + joint() + joint(name="k", parent="arm", child="base"), "no root: its joints form a cycle"),
        (LINKS + joint("springy"), "of no known type: 'springy'"),
        (LINKS + joint(more='<axis xyz="0 0 0"/>'), "has no direction"),
        (LINKS + joint(more='<origin xyz="1 2"/>'), "expected three numbers"),
        (LINKS + joint(more='<origin xyz="1 2 z"/>'), "'z' at the joint 'j' is not a number"),
        (LINKS + joint(more='<origin xyz="1 2 nan"/>'), "is not finite"),
        (LINKS + joint(more='<mimic joint="k"/>'), "mimics 'k', which does not exist"),
        (LINKS + '<joint name="j" type="fixed"><child link="arm"/></joint>', "the joint 'j' has no parent"),
    ],
)
def test_what_is_no_description_is_told(text: str, told: str) -> None:
    """With what is wrong."""
    from robot_state_publisher.urdf import URDFError

    with pytest.raises(URDFError, match=told):
        parse(text)
