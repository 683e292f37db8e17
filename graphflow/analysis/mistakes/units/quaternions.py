"""Angles that are written into a part of a quaternion, or read from one."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from graphflow.analysis.syntax import nodes_in

_FULL_TURN = 6.3
"""A full turn in radians: larger numbers are degrees."""
_PARTS = ("x", "y", "z", "w")
_OWNERS = ("orientation", "rotation")
_IS_HEADING = re.compile(r"(current_|robot_|cur_|start_|my_|last_|prev_)*(yaw|theta|heading|angle)")
_IS_ANGLE = re.compile(r"(?!.*(sin|cos|half|quat))(.*_)?(yaw|theta|heading|angle|pitch|roll|rad|radians|pi)")


def angles_as_quaternions(code: ast.AST) -> Iterator[tuple[int, str]]:
    """Find the lines that take a part of an orientation for an angle; each comes with a sentence."""
    for node in nodes_in(code):
        match node:
            case ast.Assign(
                targets=[ast.Name(id=name) | ast.Attribute(attr=name)],
                value=ast.Attribute(value=ast.Attribute(attr=owner) as whole, attr="z" | "w") as part,
            ) if owner in _OWNERS and _IS_HEADING.fullmatch(name):
                q = ast.unparse(whole)
                text = f"{ast.unparse(part)} is a part of a quaternion, not an angle: in the plane"
                yield node.lineno, f"{text}, write 2 * math.atan2({q}.z, {q}.w)"
            case ast.Assign(
                targets=[ast.Attribute(value=ast.Attribute(attr=owner), attr=part) as target], value=value
            ) if owner in _OWNERS and part in _PARTS and _is_angle(value):
                yield node.lineno, _text(ast.unparse(target), part, value)
            case ast.keyword(arg="rotation", value=ast.Tuple(elts=parts) | ast.List(elts=parts)) if [
                ast.unparse(part) for part in parts
            ] in (["1.0", "0.0", "0.0", "0.0"], ["1", "0", "0", "0"]):
                text = "a rotation is x, y, z, w, and (1, 0, 0, 0) turns it upside down, by 180 degrees about x"
                yield node.value.lineno, f"{text}; no turn is (0.0, 0.0, 0.0, 1.0)"
            case ast.Call(func=ast.Name(id="Quaternion") | ast.Attribute(attr="Quaternion"), keywords=given):
                for keyword in given:
                    if keyword.arg in _PARTS and _is_angle(keyword.value):
                        yield keyword.value.lineno, _text(keyword.arg, keyword.arg, keyword.value)


def _text(target: str, part: str, value: ast.expr) -> str:
    angle = ast.unparse(value)
    size = value.operand if isinstance(value, ast.UnaryOp) else value
    number = size.value if isinstance(size, ast.Constant) else 0
    if isinstance(number, (int, float)) and number > _FULL_TURN:
        angle = f"math.radians({angle})"
    text = f"{target} is a part of a quaternion, not an angle"
    if part == "w":
        return f"{text}: it is math.cos(angle / 2)"
    is_plain = isinstance(value, (ast.Name, ast.Attribute, ast.Constant)) or angle.startswith("math.radians(")
    half = f"{angle} / 2" if is_plain else f"({angle}) / 2"
    return f"{text}: write math.sin({half}), and math.cos({half}) into w"


def _is_angle(value: ast.expr) -> bool:
    """Whether an expression is larger than a part of a unit quaternion, or has the name of an angle and no sine."""
    parts = nodes_in(value)
    if any(isinstance(part, (ast.Call, ast.Subscript)) for part in parts):
        return any(isinstance(part, ast.Attribute) and part.attr == "radians" for part in parts) and _calls(parts) == 1
    match value:
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int(number) | float(number))):
            return abs(number) > 1
        case ast.Constant(value=int(number) | float(number)):
            return abs(number) > 1
    names = [p.id if isinstance(p, ast.Name) else p.attr for p in parts if isinstance(p, (ast.Name, ast.Attribute))]
    return any(_IS_ANGLE.fullmatch(name) for name in names)


def _calls(parts: list[ast.AST]) -> int:
    return sum(isinstance(part, ast.Call) for part in parts)
