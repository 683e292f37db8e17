"""Substitutions, which have no value while a launch file describes."""

from __future__ import annotations

import ast
import textwrap

import pytest

from graphflow.launchfiles.python.early_uses import early_uses


def told(text: str) -> list[tuple[int, str]]:
    return list(early_uses(ast.parse(textwrap.dedent(text))))


X = "LaunchConfiguration('x')"
TRUE = f"{X} has no value yet and is true in any test: write condition=IfCondition({X}) at the action"


def equal(way: str) -> str:
    return f"{X} has no value yet and equals no text: write {way}"


@pytest.mark.parametrize(
    ("test", "text"),
    [
        (X, TRUE),
        (f"not {X}", TRUE),
        (f"here and not {X}", TRUE),
        (f"{X} == 'true'", equal(f"condition=IfCondition(EqualsSubstitution({X}, 'true')) at the action")),
        (f"{X} == True", equal(f"condition=IfCondition(EqualsSubstitution({X}, 'true')) at the action")),
        (f"'a' != str({X})", equal(f"condition=IfCondition(NotEqualsSubstitution('a', {X})) at the action")),
        (
            f"f'{{{X}}}' == 'a'".replace("'x'", '"x"'),
            equal(f"condition=IfCondition(EqualsSubstitution({X}, 'a')) at the action"),
        ),
        (
            f"{X} in ('a', 'b')",
            equal(
                f"condition=IfCondition(AnySubstitution(EqualsSubstitution({X}, 'a'), EqualsSubstitution({X}, 'b'))) "
                "at the action"
            ),
        ),
        (
            f"IfCondition({X})",
            f"IfCondition({X}) has no value yet and is true in any test: write "
            f"condition=IfCondition({X}) at the action",
        ),
    ],
)
def test_tests_whose_outcome_is_fixed(test: str, text: str) -> None:
    """Each is told with its line, wherever it stands."""
    assert told(f"if {test}:\n    pass") == [(1, text)]
    assert told(f"def make():\n    return 1 if {test} else 2") == [(2, text)]


def test_comparisons_and_texts() -> None:
    """Wherever they stand."""
    text = f"{X} has no value yet, and str() makes the name of an object: write {X} alone"
    assert told(f"Node(parameters=[{{'a': {X} == 'true'}}], name=str({X}))") == [
        (1, text),
        (1, equal(f"EqualsSubstitution({X}, 'true')")),
    ]


def test_names_of_substitutions() -> None:
    """A name that is bound once stands for what it is bound to, in functions within too."""
    text = f"""
    def generate_launch_description():
        x = launch.substitutions.{X}

        def setup(context):
            if x:
                pass
    """
    [(line, said)] = told(text)
    assert line == 6
    assert said.startswith(f"launch.substitutions.{X} has no value yet")


@pytest.mark.parametrize(
    ("argument", "way"),
    [
        (f"{X} == 'sim'", f"EqualsSubstitution({X}, 'sim')"),
        (f"predicate_expression={X} == 1", f"EqualsSubstitution({X}, '1')"),
        (f"not {X}", f"NotSubstitution({X})"),
        (f"{X} and {X} != 'a'", f"AndSubstitution({X}, NotEqualsSubstitution({X}, 'a'))"),
        (f"{X} or {X} or {X}", f"AnySubstitution({X}, {X}, {X})"),
        (f"{X} not in ['a']", f"NotSubstitution(AnySubstitution(EqualsSubstitution({X}, 'a')))"),
    ],
)
def test_what_python_makes_of_a_condition(argument: str, way: str) -> None:
    """The substitutions that do the same while the launch runs; once, at the condition."""
    [(line, said)] = told(f"Node(\n    condition=IfCondition(\n    {argument}))")
    assert (line, said.partition(": write ")[2]) == (2, f"IfCondition({way})")


def test_outside_of_tests() -> None:
    """The outcome of a comparison is as fixed where it is kept; in a function that has the context, that is used."""
    assert told(f"x = {X} == 'a'") == [(1, equal(f"EqualsSubstitution({X}, 'a')"))]
    assert told(f"def setup(context):\n    if {X} == 'a': pass") == [
        (2, f"{X} is an object and equals no text: write {X}.perform(context)")
    ]


def test_texts_of_objects() -> None:
    """str() of a substitution is no value."""
    assert told(f"x = {X}\ny = str(x)") == [
        (2, f"{X} has no value yet, and str() makes the name of an object: write {X} alone")
    ]
    [(_, said)] = told(f"def setup(context):\n    return int(str({X}))")
    assert said.endswith(f"write {X}.perform(context)")


@pytest.mark.parametrize(
    "text",
    [
        f"x = {X}\nif x == None: pass",
        f"x = {X}\nif x in known: pass",
        f"IfCondition({X})",
        f"IfCondition(PythonExpression([{X}, ' == 1']))",
        f"IfCondition('true' if here else {X})",
        "y = str(context.perform_substitution(x))",
        f"x = {X}.perform(context)\nif x == 'true': pass",
        f"if {X}.perform(context) == 'true': pass",
        "if context.launch_configurations['x'] == 'true': pass",
        f"x = None\nif here:\n    x = {X}\nif x: pass",
        f"x = {X}\n\ndef make(x=None):\n    if x: pass\n",
        f"x = {X}\n\ndef make():\n    for x in range(3):\n        if x: pass\n",
        f"x = {X}\nif x is not None: pass",
        f"x = {X}\ny = x or ''",
        f"x = {X}\nif isinstance(x, str): pass",
        f"x = {X}\nif y == 'true' or str(y): pass",
        f"node = Node(condition=IfCondition({X}))\nif node: pass",
    ],
)
def test_tests_of_other_things(text: str) -> None:
    """They are left alone: values that functions have performed, names that may be several things, arguments."""
    assert told(text) == []
