"""Substitutions, which have no value while a launch file describes."""

from __future__ import annotations

import ast
import textwrap

import pytest

from graphflow.supervisor.launch_early import early_uses


def told(text: str) -> list[tuple[int, str]]:
    return list(early_uses(ast.parse(textwrap.dedent(text))))


X = "LaunchConfiguration('x')"
TRUE = f"{X} has no value yet and is true in any test: write condition=IfCondition({X}) at the action"
EQUAL = f"{X} has no value yet and equals no text: write EqualsSubstitution({X}, 'true')"


@pytest.mark.parametrize(
    ("test", "text"),
    [
        (X, TRUE),
        (f"not {X}", TRUE),
        (f"here and not {X}", TRUE),
        (f"{X} == 'true'", EQUAL),
        (f"{X} != 'true'", EQUAL),
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
    assert told(f"Node(parameters=[{{'a': {X} == 'true'}}], name=str({X}))") == [(1, text), (1, EQUAL)]


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
    "text",
    [
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
