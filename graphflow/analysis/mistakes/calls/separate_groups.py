"""Groups made where handlers name them, `group=Group(1)`: each is a group of its own, and excludes no other handler."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from graphflow.analysis.syntax import FunctionNode, last_name


def separate_groups(definition: ast.ClassDef) -> Iterator[tuple[int, str]]:
    """Find the second such handler of a class; it comes with the shared group."""
    made = [
        word.value
        for method in definition.body
        if isinstance(method, FunctionNode)
        for decorator in method.decorator_list
        if isinstance(decorator, ast.Call)
        for word in decorator.keywords
        if word.arg == "group" and isinstance(word.value, ast.Call) and last_name(word.value.func) == "Group"
    ]
    if len(made) > 1:
        shown = ast.unparse(made[1])
        text = f"this {shown} is another group than that in line {made[0].lineno}, and the two handlers may overlap"
        yield made[1].lineno, f"{text}; to share one, write shared = {shown} in the class, and group=shared in both"
