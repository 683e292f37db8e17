"""Numbers written as strings, `gain = Param("5.0")`, found when a handler computes with them."""

from __future__ import annotations

import inspect
import re
from typing import Any

from graphflow.analysis.user_code import is_users, parts_of
from graphflow.runtime.declarations.declare import Param

_CALCULATED = re.compile(
    r"can't multiply sequence by non-int|unsupported operand type\(s\) for .*'str'|not supported between .*'str'|"
    r'must be real number, not str|can only concatenate str \(not "(int|float)"\)|bad operand type for .*\'str\''
)
_OWN = re.compile(r"\bself\.(\w+)\b(?!\s*\()")


def text_for_number(error: TypeError, line: str) -> str:
    """Return the correction for an attribute that is a string and stands for a number; "" if there is none.

    Args:
        line: The user's line that raised the error.
    """
    frames = [part.tb_frame for part in parts_of(error.__traceback__) if is_users(part.tb_frame.f_code.co_filename)]
    node: Any = frames[-1].f_locals.get("self") if frames else None
    if node is None or not _CALCULATED.search(str(error)):
        return ""
    for name in _OWN.findall(line):
        declared = inspect.getattr_static(type(node), name, None)
        if isinstance(declared, Param):
            number = _number(declared.parameter.default)
            if number:
                return f"self.{name} is the string {declared.parameter.default!r}: write {name} = Param({number})"
        elif number := _number(value := inspect.getattr_static(node, name, None)):
            return f"self.{name} is the string {value!r}: write {number}, without quotes"
    return ""


def _number(value: object) -> str:
    """Return the number that a string spells; "" for anything else."""
    try:
        return repr(float(value) if "." in value or "e" in value else int(value)) if isinstance(value, str) else ""
    except ValueError:
        return ""
