"""Undefined names that are attributes of the class, of a parent, or of the node."""

from __future__ import annotations

import ast
import inspect
import linecache
import re
import sys
from importlib import import_module
from types import CodeType, FrameType, ModuleType
from typing import Any

from graphflow.analysis.syntax import first_line, nodes_in, syntax_of
from graphflow.analysis.user_code import is_users, parts_of

MODULES = {name: f"import {name}" for name in sys.stdlib_module_names} | {"np": "import numpy as np"}
"""The lines that import modules under their usual names."""


def owner_of(error: NameError) -> str:
    """Return the correct form of a name that Python does not find; "" if it is not an attribute of a class.

    A class body does not see the names of its parents, and a method does not see those of its class.
    """
    frames = [part.tb_frame for part in parts_of(error.__traceback__) if is_users(part.tb_frame.f_code.co_filename)]
    name = error.name
    if not frames:
        return ""
    frame = frames[-1]
    if isinstance(error, UnboundLocalError):
        return unbound_local(error, frame)
    if not name:
        return ""
    if "__qualname__" in frame.f_locals and not frame.f_code.co_flags & inspect.CO_OPTIMIZED:
        for base in _bases(frame):
            parent = _value(base, frame)
            if isinstance(parent, type) and inspect.getattr_static(parent, name, None) is not None:
                return f"a class body does not see its parent's names: write {ast.unparse(base)}.{name}"
    if name == "self":
        return _without_self(frame)
    node = frame.f_locals.get("self")
    if node is not None and not name.startswith("__") and inspect.getattr_static(node, name, None) is not None:
        return f"a method does not see the names of its class: write self.{name}"
    return _missing_import(name, linecache.getline(frame.f_code.co_filename, frame.f_lineno))


def _without_self(frame: FrameType) -> str:
    """Return the correct form of `self.name` in a class body, or in a function that is no method."""
    line = linecache.getline(frame.f_code.co_filename, frame.f_lineno)
    found = re.search(r"\bself\.(\w+)", line)
    if "__qualname__" in frame.f_locals:
        return f"a class body has no self: write {found[1]}" if found is not None else ""
    if not frame.f_code.co_flags & inspect.CO_OPTIMIZED:  # the module's own lines
        return "only methods have self: move the line into one"
    function = frame.f_code.co_name
    if not function.isidentifier():  # a comprehension of a class body
        return ""
    code = frame.f_code
    if re.search(rf"\w\.{function}$", code.co_qualname):
        if code.co_argcount:
            return f"the first parameter of {function} is called {code.co_varnames[0]}: call it self"
        return f"{function} has no parameters: write def {function}(self), without @staticmethod"
    return f"{function} is no method: indent it below its class as def {function}(self, ...), or give it the node"


def home_of(name: str) -> str:
    """Return the module of graphflow's that has a public name; "" if none has."""
    homes = ("graphflow", "graphflow.tf", "graphflow.testing")
    return next((home for home in homes if name in import_module(home).__all__), "")


def _missing_import(name: str, line: str) -> str:
    """Return the line that imports a name, if it is one of graphflow's, a type's, or a module's; "" if it is none.

    Args:
        line: The line that uses it.
    """
    from graphflow.msgs.homes import imports

    home = home_of(name)
    if home and re.search(rf"\b{name}\.\w", line):  # an attribute that a message's class has not
        return f"write from {home} import {name}"
    lines = [f"from {home} import {name}" if home else "", imports(name, "graphflow.msgs.")]
    if any(lines):
        return f"write {' or '.join(filter(None, lines))}"
    return f"write {MODULES[name]}" if name in MODULES else ""


def unbound_local(error: UnboundLocalError, frame: FrameType) -> str:
    """Return the correct form of a variable that is local because the function sets it, as in `count += 1`."""
    found = re.search(r"variable '(\w+)'", str(error))
    if found is None:
        return ""
    name, node = found[1], frame.f_locals.get("self")
    line = linecache.getline(frame.f_code.co_filename, frame.f_lineno)
    is_set_here = re.match(rf"\s*{name}\s*([-+*/%|&]|//|\*\*)?=", line)
    if node is not None and inspect.getattr_static(node, name, None) is not None:
        return f"write self.{name}" if is_set_here else ""
    stores = _stores(frame.f_code, name)
    if name in frame.f_globals and stores:
        where = "this line" if stores[0] == frame.f_lineno else f"line {stores[0]}"
        return f"{where} sets {name}, which makes it local: write global {name} at the top of {frame.f_code.co_name}"
    return f"only line {stores[0]} sets it, and has not run" if len(stores) == 1 and not is_set_here else ""


def _stores(code: CodeType, name: str) -> list[int]:
    """Return the lines of a function that set a variable, in the order of the source; none without a source."""
    try:
        functions = syntax_of(code.co_filename).functions
    except (OSError, SyntaxError, ValueError):
        return []
    own = [item for item in functions if first_line(item) == code.co_firstlineno and item.name == code.co_name]
    names = [node for item in own for node in nodes_in(item) if isinstance(node, ast.Name) and node.id == name]
    return sorted(node.lineno for node in names if isinstance(node.ctx, ast.Store))


def _bases(frame: FrameType) -> list[ast.expr]:
    """Return the bases of the class whose body runs in a frame, as expressions."""
    try:
        classes = syntax_of(frame.f_code.co_filename).classes
    except (OSError, SyntaxError, ValueError):  # no readable source
        return []
    first = frame.f_code.co_firstlineno
    for item in classes:
        lines = {item.lineno, *(decorator.lineno for decorator in item.decorator_list)}
        if item.name == frame.f_code.co_name and first in lines:
            return item.bases
    return []


def _value(expression: ast.expr, frame: FrameType) -> Any:
    """Return the value of a possibly dotted name, as far as no user code has to run for it."""
    match expression:
        case ast.Name(id=name):
            return {**frame.f_globals, **(frame.f_back.f_locals if frame.f_back else {})}.get(name)
        case ast.Attribute(value=value, attr=name):
            owner = _value(value, frame)
            return vars(owner).get(name) if isinstance(owner, (ModuleType, type)) else None
    return None
