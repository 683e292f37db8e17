"""Misplaced declarations, which have no effect: under another decorator, in a tuple, outside a class."""

from __future__ import annotations

import ast
import dis
import functools
import inspect
import sys
from collections.abc import Collection, Iterator, Mapping
from types import CellType, CodeType, FunctionType

from graphflow.errors import DeclarationError, Place
from graphflow.runtime.declarations import declared
from graphflow.runtime.declarations.declare import HOOK_MARK, Declaration, Param, ParamHook
from graphflow.runtime.declarations.handlers import MARK, Handler


def check_misplaced(cls: type) -> None:
    """Check that every declaration in a class body takes effect.

    Raises:
        DeclarationError: One does not; the text has its line and the correct form.
    """
    known = {id(value) for parent in cls.__mro__ for value in vars(parent).values()}
    for attribute, value in vars(cls).items():
        for inner in _wrapped_by(value):
            if id(inner) not in known:
                _refuse_wrapped(attribute, value, inner)
        if isinstance(value, (tuple, list, set, dict)) and not attribute.startswith("__"):
            _refuse_collected(attribute, value, known)
    # Up to Python 3.13, annotations are evaluated with the class body; later versions do so on access.
    annotations = vars(cls).get("__annotations__", {})
    for attribute, value in annotations.items() if isinstance(annotations, Mapping) else ():
        if isinstance(value, Declaration):
            raise DeclarationError(f"{value.place}: {attribute} is only annotated; write = instead of the colon")
        if (inner := next(_handlers_in(value), None)) is not None:
            raise DeclarationError(f"{inner.place}: @{inner.kind} goes above a method; {attribute} is only annotated")
        if isinstance(value, str) and _declares(value, vars(sys.modules[cls.__module__])):
            place = f"{declared.place_of(cls)}: {cls.__name__}.{attribute}"
            raise DeclarationError(f"{place} is only annotated, as {value}; write = instead of the colon")


def _declares(annotation: str, space: Mapping[str, object]) -> bool:
    """Whether the text of an annotation is a declaration, such as `Publisher(String, "chatter")`."""
    try:
        expression = ast.parse(annotation, mode="eval").body
    except (SyntaxError, ValueError):
        return False
    function = expression.func if isinstance(expression, ast.Call) else None
    if isinstance(function, ast.Attribute):
        return isinstance(function.value, ast.Name) and function.value.id == "graphflow"
    found = space.get(function.id) if isinstance(function, ast.Name) else None
    return isinstance(found, type) and issubclass(found, Declaration)


def _wrapped_by(value: object) -> Iterator[object]:
    """Return marked functions that an attribute wraps instead of being one itself."""
    if _is_marked(value) or isinstance(value, (Declaration, type)):
        return
    inner: list[object]
    if isinstance(value, property):
        inner = [value.fget, value.fset]
    elif isinstance(value, (staticmethod, classmethod)):
        inner = [value.__func__]
    elif isinstance(value, (functools.partial, functools.partialmethod)):
        inner = [value.func]
    elif inspect.isfunction(value):
        inner = [_content(cell) for cell in value.__closure__ or ()]
    else:
        inner = list(getattr(value, "__dict__", {}).values())
    yield from (fn for fn in inner if inspect.isfunction(fn) and _is_marked(fn))


def _is_marked(value: object) -> bool:
    return hasattr(value, MARK) or hasattr(value, HOOK_MARK)


def _content(cell: CellType) -> object:
    try:
        return cell.cell_contents
    except ValueError:  # an empty cell
        return None


def _handlers_in(value: object) -> Iterator[Handler]:
    """Return the handlers that a decorator such as `timer(1.0)` would set as marks."""
    for cell in (value.__closure__ or ()) if isinstance(value, FunctionType) else ():
        if isinstance(found := _content(cell), Handler):
            yield found


def _refuse_wrapped(attribute: str, value: object, inner: object) -> None:
    mark: Handler | ParamHook = getattr(inner, MARK, None) or getattr(inner, HOOK_MARK)
    own = f"@{mark.kind}" if isinstance(mark, Handler) else f"@{mark.param.attribute}.{mark.kind}"
    if isinstance(value, (property, staticmethod, classmethod)):
        way = f"{own} goes on a plain method; leave out @{type(value).__name__}"
    else:
        name = getattr(value, "__qualname__", type(value).__qualname__).partition(".<locals>")[0].rpartition(".")[2]
        way = f"{own} goes above @{name}, or functools.wraps(fn) into what that returns"
    raise DeclarationError(f"{mark.place}: {attribute} would never run, because the decorator above hides it; {way}")


def _refuse_collected(attribute: str, value: Collection[object], known: Collection[int]) -> None:
    for item in value.values() if isinstance(value, dict) else value:
        if not isinstance(item, Declaration) or id(item) in known:
            continue
        kind = type(item).__name__
        if isinstance(value, tuple) and len(value) == 1:
            raise DeclarationError(
                f"{item.place}: {attribute} is a tuple because of the comma after {kind}(...); remove it"
            )
        way = "give each an attribute of its own"
        if not isinstance(item, Param):
            maker = item.MAKER.partition("(")[0]
            way += f", or make them in __init__: self.{attribute} = [self.{maker}(...), ...]"
        raise DeclarationError(f"{item.place}: a {kind} in a {type(value).__name__} is not the node's; {way}")


def check_made(node: object) -> None:
    """Check that a node's `__init__` has not assigned declarations, which belong in the class body.

    Raises:
        DeclarationError: It has assigned one.
    """
    for attribute, value in vars(node).items():
        if isinstance(value, Declaration) and not value.attribute:
            raise DeclarationError(f"{value.place}: {not_of_node(attribute, type(value))}")


def not_of_node(attribute: str, kind: type[Declaration]) -> str:
    """Return the sentence for a declaration that is assigned to an attribute of a node."""
    way = f"write {attribute} = {kind.__name__}(...) in the body of the class"
    if not issubclass(kind, Param) and kind.MAKER.startswith("create_"):
        way += f", or self.{attribute} = self.{kind.MAKER.partition('(')[0]}(...) here"
    return f"self.{attribute} is not a {kind.__name__} of the node; {way}"


def check_hooks(cls: type) -> None:
    """Check that awaited hooks are an `async def` or return an awaitable, and that `__init__` is not one.

    Raises:
        DeclarationError: A hook cannot be awaited, or `__init__` would have to be.
    """
    if inspect.iscoroutinefunction(init := vars(cls).get("__init__")):
        place = Place(init.__code__.co_filename, init.__code__.co_firstlineno)
        way = "write def __init__, and await in async def on_start(self)"
        raise DeclarationError(f"{place}: Python does not await {cls.__name__}.__init__; {way}")
    for name in ("on_start", "on_shutdown"):
        hook = vars(cls).get(name)
        if (mark := getattr(hook, MARK, None)) is not None:
            way = "leave out its decorator, or give a handler a name of its own"
            raise DeclarationError(f"{mark.place}: the node itself calls {name}: {way}")
        if inspect.isfunction(hook) and not inspect.iscoroutinefunction(hook) and _returns_nothing(hook.__code__):
            place = Place(hook.__code__.co_filename, hook.__code__.co_firstlineno)
            raise DeclarationError(f"{place}: {name} is awaited; write async def {name}(self)")


def _returns_nothing(code: CodeType) -> bool:
    before = None
    for step in dis.get_instructions(code):
        if step.opname == "RETURN_VALUE" and not (before and before.opname == "LOAD_CONST" and before.argval is None):
            return False
        # In CPython 3.12 and 3.13 only.
        if step.opname == "RETURN_CONST" and step.argval is not None:
            return False
        before = step
    return True


def check_module(cls: type) -> None:
    """Check that no handler is defined at module level, outside the class.

    Raises:
        DeclarationError: One is.
    """
    module = sys.modules.get(cls.__module__)
    values = list(vars(module).values()) if module is not None else []
    known = {id(value) for one in values if isinstance(one, type) for value in vars(one).values()}
    for value in values:
        mark = getattr(value, MARK, None) if inspect.isfunction(value) else None
        if isinstance(mark, Handler) and value.__module__ == cls.__module__ and id(value) not in known:
            text = f"@{mark.kind} goes on a method, and {value.__name__} is outside a class; indent it into one"
            raise DeclarationError(f"{mark.place}: {text}")
