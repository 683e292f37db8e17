"""The names by which a file knows functions of `math`, turtlesim poses, and the values that it keeps."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from functools import cache

from graphflow.analysis.bindings import Bindings, bindings_of
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in

_LIBRARIES = ("math", "np", "numpy")
DEPTH = 4
"""The number of names that are followed to a value."""


class PoseNames:
    """The imports of a file, the bindings of its names, and which of these are turtlesim poses."""

    def __init__(self, module: ast.Module) -> None:
        self.bindings: Bindings = bindings_of(module)
        self.functions: set[str] = set()
        """Functions of `math` and NumPy that are imported by name."""
        self.poses: set[str] = set()
        """Names of turtlesim's Pose."""
        has_own_theta = False
        for node in nodes_in(module):
            match node:
                case ast.ImportFrom(module=str(path), names=names) if path in _LIBRARIES:
                    self.functions |= {alias.name for alias in names if alias.asname is None}
                case ast.ImportFrom(module=str(path), names=names) if path.endswith("turtlesim.msg"):
                    self.poses |= {alias.asname or alias.name for alias in names if alias.name == "Pose"}
                case ast.Attribute(attr="theta", ctx=ast.Store()):
                    has_own_theta = True
        if has_own_theta:
            self.poses = set()  # somebody may keep degrees there
        self.callbacks: set[str] = set()
        """Methods that are passed to `create_subscription` for such poses."""
        for node in nodes_in(module) if self.poses else ():
            match node:
                case ast.Call(func=ast.Attribute(attr="create_subscription"), args=[type_, _, callback, *_]):
                    self.callbacks |= {last_name(callback)} if last_name(type_) in self.poses else set()

    def called(self, function: ast.expr) -> str:
        """Return the name of a function of `math` or NumPy; empty for any other."""
        match function:
            case ast.Attribute(value=ast.Name(id=library), attr=name) if library in _LIBRARIES:
                return name
            case ast.Name(id=name) if name in self.functions:
                return name
        return ""

    def is_pose(self, expression: ast.expr, parents: Sequence[ast.AST], depth: int = 0) -> bool:
        """Whether an expression is a turtlesim pose that a handler received, or an attribute that keeps one."""
        if not self.poses or not isinstance(expression, (ast.Name, ast.Attribute)):
            return False
        if isinstance(expression, ast.Name):
            function = next((p for p in reversed(parents) if isinstance(p, FunctionNode)), None)
            argument = next((a for a in function.args.args if a.arg == expression.id), None) if function else None
            if function is not None and argument is not None:
                return self._receives(function, argument)
        values = [v for v in self.bindings.of(expression, parents) if not _is_none(v.expression)]
        return (
            bool(values)
            and depth < DEPTH
            and all(
                value is not None and (self._makes(value) or self.is_pose(value, around, depth + 1))
                for value, around in values
            )
        )

    def _makes(self, value: ast.expr) -> bool:
        return isinstance(value, ast.Call) and last_name(value.func) in self.poses

    def _receives(self, function: FunctionNode, argument: ast.arg) -> bool:
        if argument.annotation is not None:
            return last_name(argument.annotation) in self.poses
        if function.name in self.callbacks:
            return True
        calls = [decorator for decorator in function.decorator_list if isinstance(decorator, ast.Call)]
        return any(
            last_name(call.func) == "subscription" and bool(call.args) and last_name(call.args[0]) in self.poses
            for call in calls
        )


@cache
def pose_names(module: ast.Module) -> PoseNames:
    """Return the names of a module, collected once."""
    return PoseNames(module)


def _is_none(value: ast.expr | None) -> bool:
    return isinstance(value, ast.Constant) and value.value is None
