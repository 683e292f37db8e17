"""What `$(eval ...)` may say, and that nothing else comes of it."""

from __future__ import annotations

import time
from typing import Any

import pytest

from graphflow.markup.expressions import ExpressionError, evaluate, with_quotes
from graphflow.markup.source import Data

NAMES: dict[str, Data] = {"count": 3, "mode": "sim", "turtle": {"name": "leo", "x": 1.5}, "ids": [4, 5]}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("count * 2 + 1", 7),
        ("-count // 2", -2),
        ("2 ** 10", 1024),
        ("7 % 4", 3),
        ("'a' + 'b'", "ab"),
        ("mode == 'sim' and count > 2", True),
        ("not true or false", False),
        ("mode in ['sim', 'real']", True),
        ("1.5 if mode == 'real' else 2.5", 2.5),
        ("range(1, count)", [1, 2]),
        ("ids[1]", 5),
        ("turtle.name", "leo"),
        ("turtle['x']", 1.5),
        ("round(pi, 2)", 3.14),
        ("str(count) + '_' + mode", "3_sim"),
        ("len(ids) + sum(ids) + max(ids)", 16),
        ("sqrt(radians(180) * 0 + 4)", 2.0),
    ],
)
def test_values(text: str, value: Any) -> None:
    """Arithmetic, comparisons, choices, lists, and the parts of what the graph's arguments are."""
    assert evaluate(f" {text} ", NAMES) == value


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("cont * 2", "'cont' is no argument; did you mean 'count'?"),
        ("mode == real", "'real' is no argument; a text is written in quotes: 'real'"),
        ("arg('x') == 1", "there is no function 'arg'; write the argument's name alone"),
        ("exec('x')", "there is no function 'exec'; there are abs, bool"),
        ("count.real", "nothing called 'real' is in 3"),
        ("turtle.nam", "nothing called 'nam' is in"),
        ("''.__class__", "nothing called '__class__'"),
        ("mode.upper()", "nothing called 'upper' is in 'sim'"),
        ("[i for i in ids]", "only arithmetic, comparisons and choices can be written here"),
        ("lambda: 1", "only arithmetic, comparisons and choices can be written here"),
        ("f'{mode}'", "only arithmetic, comparisons and choices can be written here"),
        ("1 +", "not an expression: "),
        ("count = 4", "not an expression: "),
        ("1; 2", "not an expression: "),
        ("", "not an expression: "),
        ("1 / 0", "division by zero"),
        ("1 + 'a'", "unsupported operand"),
        ("ids[7]", "list index out of range"),
        ("9 ** 99999", r"9\*\*99999 is too large"),
        ("'a' * 10 ** 9", r"\*, \*\* and % are for numbers"),
        ("'%1000000000d' % 3", r"\*, \*\* and % are for numbers"),
        ("range(10 ** 9)", "a range has at most 10000 numbers"),
        ("1" * 1001, "an expression has at most 1000 characters"),
        ("-" * 900 + "1", "nested too deep|not an expression"),
    ],
)
def test_what_is_refused(text: str, message: str) -> None:
    """Anything that is not a value here is refused in words, and at once."""
    began = time.monotonic()
    with pytest.raises(ExpressionError, match=message):
        evaluate(text, NAMES)
    assert time.monotonic() - began < 60.0  # it has not been computed: that would take hours


@pytest.mark.parametrize(
    ("text", "quoted"),
    [
        ("'real' == sim or real != 'a'", "'real' == 'sim' or 'real' != 'a'"),
        ("math.pi * max(1, pi) > 3 and true", "math.pi * max(1, pi) > 3 and true"),
        ("sim ==", "sim =="),
        ("'\u00e9' == sim", "'\u00e9' == sim"),
    ],
)
def test_texts_without_quotes(text: str, quoted: str) -> None:
    """Names of nothing are texts; what cannot be parsed stays."""
    assert with_quotes(text) == quoted
