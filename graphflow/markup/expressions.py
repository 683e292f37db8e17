"""Expressions of `$(eval ...)`: arithmetic, comparisons and choices over a graph's arguments, and nothing else.

Numbers, texts and lists, `and`, `or`, `not`, `in`, `x if y else z`, and a few functions. No attributes, no methods, no
imports; every result is bounded in size, so that reading a file takes bounded time and memory.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from typing import Any

from graphflow.markup.source import Data
from graphflow.names import did_you_mean

MAX_LENGTH = 1000
"""Characters of an expression."""
MAX_BITS = 4096
"""Bits of a power."""
MAX_LIST = 10_000
"""Elements of a list."""
MAX_TEXT = 100_000
"""Characters of a text."""


class ExpressionError(ValueError):
    """An expression is malformed, or has no value."""


def evaluate(text: str, names: Mapping[str, Data]) -> Data:
    """Evaluate an expression.

    Args:
        names: Values by the names that the expression may use.

    Raises:
        ExpressionError: The expression is not allowed, uses an unknown name, or has no value.
    """
    import simpleeval

    if len(text) > MAX_LENGTH:
        raise ExpressionError(f"an expression has at most {MAX_LENGTH} characters")
    evaluator = simpleeval.EvalWithCompoundTypes(
        operators={**simpleeval.DEFAULT_OPERATORS, ast.Pow: _power, ast.Mult: _times, ast.Mod: _modulo},
        functions=dict(FUNCTIONS),  # a copy: simpleeval adds to it
        names={"math": _MATH, **names, "true": True, "false": False, "pi": math.pi},
    )
    # These could make great values before `_bounded` sees them.
    for kind in (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp, ast.JoinedStr):
        evaluator.nodes.pop(kind, None)
    # Only entries of mappings: by Python's attributes an expression would reach everything.
    evaluator.nodes[ast.Attribute] = lambda node: _entry(evaluator.eval(text, node.value), node.attr)
    try:
        ast.parse(text.strip(), mode="eval")  # simpleeval would accept a statement, too
        return _bounded(evaluator.eval(text.strip()))
    except simpleeval.NameNotDefined as error:
        near = did_you_mean(error.name, names) or f"; a text is written in quotes: {error.name!r}"
        raise ExpressionError(f"{error.name!r} is no argument{near}") from None
    except simpleeval.FunctionNotDefined as error:
        hint = "write the argument's name alone" if error.func_name == "arg" else f"there are {', '.join(FUNCTIONS)}"
        raise ExpressionError(f"there is no function {error.func_name!r}; {hint}") from None
    except simpleeval.FeatureNotAvailable:
        raise ExpressionError("only arithmetic, comparisons and choices can be written here") from None
    except SyntaxError as error:
        raise ExpressionError(f"not an expression: {error.msg}") from None
    except RecursionError:
        raise ExpressionError("nested too deep") from None
    except (simpleeval.InvalidExpression, ArithmeticError, TypeError, ValueError, LookupError) as error:
        raise ExpressionError(str(error) or type(error).__name__) from None


def with_quotes(expression: str) -> str:
    """Put quotes around the names in an expression that have no value there, as if they were texts."""
    if not expression.isascii():  # columns of the syntax tree count bytes
        return expression
    try:
        tree = ast.parse(expression, mode="eval")
    except SyntaxError:
        return expression
    named = [node for node in ast.walk(tree) if isinstance(node, ast.Name) and node.id not in _KNOWN]
    for node in sorted(named, key=lambda node: node.col_offset, reverse=True):
        expression = f"{expression[: node.col_offset]}{node.id!r}{expression[node.end_col_offset :]}"
    return expression


def _bounded(value: Any) -> Data:
    """Refuse a value that is too large: arguments made of arguments could double it again and again."""
    if isinstance(value, (list, tuple, dict, set)) and len(value) > MAX_LIST:
        raise ExpressionError(f"a list has at most {MAX_LIST} elements")
    if isinstance(value, str) and len(value) > MAX_TEXT:
        raise ExpressionError(f"a text has at most {MAX_TEXT:,} characters")
    result: Data = value
    return result


def _entry(value: object, name: str) -> object:
    if not isinstance(value, dict) or name not in value:
        raise ExpressionError(f"nothing called {name!r} is in {value!r}")
    return value[name]


def _power(base: object, exponent: object) -> object:
    x, y = _number(base), _number(exponent)
    if isinstance(x, int) and x.bit_length() * abs(y) > MAX_BITS:
        raise ExpressionError(f"{base}**{exponent} is too large")
    return x**y


def _times(left: object, right: object) -> float:
    return _number(left) * _number(right)


def _modulo(left: object, right: object) -> float:
    return _number(left) % _number(right)


def _number(value: object) -> float:
    """Refuse any other operand: texts and lists grow when they are multiplied or formatted."""
    if not isinstance(value, (int, float)):
        raise ExpressionError("*, ** and % are for numbers")
    return value


def _range(*bounds: int) -> list[int]:
    found = range(*bounds)
    if len(found) > MAX_LIST:
        raise ExpressionError(f"a range has at most {MAX_LIST} numbers")
    return list(found)


FUNCTIONS: dict[str, Callable[..., object]] = {
    **{f.__name__: f for f in (abs, bool, float, int, len, max, min, round, str, sum)},
    **{
        f.__name__: f for f in (math.sqrt, math.hypot, math.exp, math.log, math.log10, math.ceil, math.floor, math.fmod)
    },
    **{f.__name__: f for f in (math.sin, math.cos, math.tan, math.asin, math.acos, math.atan, math.atan2)},
    **{f.__name__: f for f in (math.radians, math.degrees, math.isfinite, math.isinf, math.isnan)},
    "range": _range,
}
"""The functions of expressions."""
_MATH = {**{name: function for name, function in FUNCTIONS.items() if hasattr(math, name)}, "pi": math.pi, "e": math.e}
"""The module `math`, as expressions of launch files name it."""
_KNOWN = {*FUNCTIONS, "math", "true", "false", "pi"}
