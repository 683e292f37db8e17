"""What code does to what it mentions."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.attribute_uses import called_back, is_own, knows, reaches_by_name, use_of
from graphflow.analysis.syntax import FunctionNode, walk


def mention(body: str) -> tuple[ast.Attribute, list[ast.AST]]:
    """The mention of `self.x` in the body of a method, with what encloses it."""
    function = ast.parse(f"def method(self):\n    {body}").body[0]
    found = [(n, above) for n, above in walk(function) if isinstance(n, ast.Attribute) and is_own(n) and n.attr == "x"]
    [(node, parents)] = found
    return node, parents


@pytest.mark.parametrize(
    ("body", "kind"),
    [
        ("self.x = 1", "assigned"),
        ("self.x.y = 1", "changed"),
        ("self.x.append(1)", "called"),
        ("self.x()", "invoked"),
        ("with self.x: pass", "entered"),
        ("print(self.x)", "read"),
        ("return self.x.y", "part"),
        ("give(self.x)", "given"),
        ("rclpy.spin_until_future_complete(self, self.x)", "read"),
        ("self.executor.spin_until_future_complete(self.x)", "read"),
    ],
)
def test_what_is_done(body: str, kind: str) -> None:
    """By what encloses the mention."""
    assert use_of("method", *mention(body)).kind == kind


def test_functions_that_only_an_answer_calls() -> None:
    """Lambdas and functions inside a method that are given to futures, and to nobody else."""
    text = """
def method(self):
    def once(future): pass
    def twice(future): pass
    def never(): pass
    future.add_done_callback(once)
    future.add_done_callback(lambda _: None)
    future.add_done_callback(twice)
    give(twice, lambda: None)
"""
    [method] = ast.parse(text).body
    assert isinstance(method, FunctionNode)
    found = called_back(method)
    assert {getattr(one, "name", "<lambda>") for one in found} == {"once", "<lambda>"}
    assert len(found) == 2


@pytest.mark.parametrize(
    ("call", "reaches"),
    [
        ("getattr(node, name)()", True),
        ("getattr(node, 'ready')()", False),
        ("getattr(args, name)", False),
        ("vars(node).update(ready=True)", True),
        ("vars(args)", False),
        ("operator.methodcaller('go')(node)", True),
    ],
)
def test_names_that_the_source_does_not_show(call: str, reaches: bool) -> None:
    """What is called, or set, by a name that is worked out."""
    calls = [node for node in ast.walk(ast.parse(call)) if isinstance(node, ast.Call)]
    assert any(map(reaches_by_name, calls)) is reaches


@pytest.mark.parametrize(
    ("call", "is_known"), [("Own(self)", True), ("rclpy.spin_once(self)", True), ("f(self)", False)]
)
def test_who_is_given_the_node(call: str, is_known: bool) -> None:
    """What is read as well, or only runs its callbacks."""
    [parents] = [above for node, above in walk(ast.parse(call)) if isinstance(node, ast.Name) and node.id == "self"]
    assert knows(parents, {"Own"}) is is_known
