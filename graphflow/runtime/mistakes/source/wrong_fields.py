"""Fields of messages that their type does not have: `message.pos` for `message.pose`, set or read."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from types import MappingProxyType, ModuleType

from graphflow.analysis.attribute_uses import is_own
from graphflow.analysis.syntax import FunctionNode, last_name, nodes_in, walk
from graphflow.errors import EncodeError, Place
from graphflow.msgs.base import Message, no_field
from graphflow.runtime.declarations.handlers import Handler


def messages_kept(definition: ast.ClassDef, space: dict[str, object]) -> dict[str, type[Message]]:
    """Return the message classes of attributes that a class sets to nothing else, as `self.command` of `Twist()`."""
    found: dict[str, set[type[Message] | None]] = {}
    for node in nodes_in(definition):
        match node:
            case ast.Assign(targets=[ast.Attribute() as target], value=value) if is_own(target):
                if not (isinstance(value, ast.Constant) and value.value is None):
                    found.setdefault(ast.unparse(target), set()).add(_type_made(value, space))
    stores = Counter(ast.unparse(n) for n in nodes_in(definition) if is_own(n) and isinstance(n.ctx, ast.Store))
    plain = Counter(
        ast.unparse(n.targets[0]) for n in nodes_in(definition) if isinstance(n, ast.Assign) and len(n.targets) == 1
    )
    made = ((name, next(iter(types))) for name, types in found.items() if len(types) == 1)
    return {name: type_ for name, type_ in made if type_ is not None and stores[name] == plain[name]}


def wrong_fields(
    method: FunctionNode,
    handler: Handler | None,
    file: str,
    space: dict[str, object],
    kept: Mapping[str, type[Message]] = MappingProxyType({}),
) -> Iterator[str]:
    """Find fields of messages that their type does not have, and literals that do not fit them.

    Those of a service handler whose arguments are named in the wrong order have one answer.

    Args:
        handler: What the class declares the method to be.
        kept: The message classes of attributes, as `messages_kept` returns them.
    """
    found = list(_wrong_fields(method, handler, file, space, kept))
    names = [argument.arg for argument in method.args.args]
    if found and handler is not None and handler.kind == "service" and names[1:] == ["response", "request"]:
        way = f"write def {method.name}({names[0]}, request, response)"
        found = [f"{Place(file, method.lineno)}: a service handler receives the request first: {way}"]
    yield from found


def flags_of(cls: type, definition: ast.ClassDef) -> set[str]:
    """Return the attributes of a class that are true or false at first."""
    found = {name for name, value in vars(cls).items() if isinstance(value, bool)}
    for node in nodes_in(definition):
        match node:
            case ast.Assign(targets=[ast.Attribute(attr=name) as flag], value=ast.Constant(value=bool())):
                found |= {name} if is_own(flag) else set()
    return found


def whole_messages(
    flags: Collection[str], method: FunctionNode, handler: Handler | None, file: str, space: dict[str, object]
) -> Iterator[str]:
    """Find messages that are stored in place of their only bool: `self.is_on = request` is true for any request.

    Args:
        flags: The attributes that are true or false.
        handler: What the class declares the method to be.
    """
    received = _received(method, handler, space)
    for node in nodes_in(method):
        match node:
            case ast.Assign(targets=[ast.Attribute(attr=flag) as target], value=ast.Name(id=name)) if flag in flags:
                for type_ in received.get(name, ()):
                    bools = [f.name for f in type_.SCHEMA.fields if f.type.base == "bool"] if type_ is not None else []
                    if is_own(target) and len(bools) == 1:
                        text = f"{name} is the whole message, which counts as true"
                        yield f"{Place(file, node.lineno)}: {text}; write self.{flag} = {name}.{bools[0]}"


def _wrong_fields(
    method: FunctionNode,
    handler: Handler | None,
    file: str,
    space: dict[str, object],
    kept: Mapping[str, type[Message]],
) -> Iterator[str]:
    bound = _received(method, handler, space)
    times = _meanings(method, bound, space)
    # A name with several meanings, or bound by a loop, is treated as unknown.
    made = {
        name: type_
        for name, types in bound.items()
        if len(types) == 1 and not times[name] and (type_ := next(iter(types))) is not None
    } | dict(kept)
    for node, parents in walk(method):
        match node:
            case ast.Attribute(ctx=ast.Load(), attr=field) if type_ := _type_of(node.value, made):
                if not (_has(type_, field) or any(_expects(parent, node.value) for parent in parents)):
                    yield f"{Place(file, node.lineno)}: {no_field(type_, field)}"
            case ast.Assign(targets=[ast.Attribute(value=owner, attr=field)], value=value):
                type_ = _type_of(owner, made)
                if type_ is not None and (text := _misfit(type_, field, value)):
                    yield f"{Place(file, node.lineno)}: {text}"


def _meanings(
    method: FunctionNode, bound: dict[str, set[type[Message] | None]], space: dict[str, object]
) -> Counter[str]:
    """Count the meanings of each name beside messages that are assigned to it, which are added to `bound`."""
    times: Counter[str] = Counter()
    for node in nodes_in(method):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                bound.setdefault(name, set()).add(_type_made(value, space))
                times[name] -= 1
            case (
                ast.Name(id=name, ctx=ast.Store())
                | ast.ExceptHandler(name=str(name))
                | ast.MatchAs(name=str(name))
                | ast.MatchStar(name=str(name))
            ):
                times[name] += 1
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.Lambda() if node is not method:
                times.update(argument.arg for argument in nodes_in(node.args) if isinstance(argument, ast.arg))
            case ast.Call(func=ast.Name(id="isinstance" | "hasattr"), args=[ast.Name(id=name), *_]):
                times[name] += 1  # its type is looked at
    return times


def _type_made(value: ast.expr, space: dict[str, object]) -> type[Message] | None:
    """Return the message class that an expression instantiates, as in `String()`."""
    return message_of(value.func, space) if isinstance(value, ast.Call) else None


def message_of(expression: ast.expr | None, space: dict[str, object]) -> type[Message] | None:
    """Return the message class that an expression names."""
    type_ = resolved(expression, space)
    return type_ if isinstance(type_, type) and issubclass(type_, Message) else None


def _misfit(type_: type[Message], field: str, value: ast.expr) -> str:
    if field not in {f.name for f in type_.SCHEMA.fields}:
        return "" if _has(type_, field) else no_field(type_, field)
    try:
        literal = ast.literal_eval(value)
    except (ValueError, TypeError, SyntaxError):
        return ""
    try:
        type_(**{field: literal}).to_bytes()
    except EncodeError as error:
        return str(error)
    return ""


def _received(
    method: FunctionNode, handler: Handler | None, space: dict[str, object]
) -> dict[str, set[type[Message] | None]]:
    """Return the message classes of a method's arguments, by their annotations or by its decorator."""
    given: list[type[Message] | None] = []
    if handler is not None and handler.kind == "subscription":
        given = [None, handler.type]
    elif handler is not None and handler.kind == "service":
        given = [None, handler.type.Request, handler.type.Response]
    found: dict[str, set[type[Message] | None]] = {}
    for number, argument in enumerate(method.args.args):
        of_decorator = given[number] if number < len(given) and argument.annotation is None else None
        found[argument.arg] = {of_decorator or message_of(argument.annotation, space)}
    return found


def _type_of(expression: ast.expr, made: Mapping[str, type[Message]]) -> type[Message] | None:
    """Return the message class of a name, of an attribute of the node, or of a field that is a message itself."""
    if isinstance(expression, ast.Name):
        return made.get(expression.id)
    if is_own(expression):
        return made.get(ast.unparse(expression))
    if not isinstance(expression, ast.Attribute) or (type_ := _type_of(expression.value, made)) is None:
        return None
    if expression.attr not in {field.name for field in type_.SCHEMA.fields}:
        return None
    value = getattr(type_(), expression.attr, None)
    return type(value) if isinstance(value, Message) else None


def _has(type_: type[Message], field: str) -> bool:
    return field in {f.name for f in type_.SCHEMA.fields} or hasattr(type_, field) or field.startswith("__")


def _expects(parent: ast.AST, message: ast.expr) -> bool:
    """Whether the statement expects that an attribute of a message may be missing.

    An `except` for any error expects it if it is for one plain line, or reads the message another way.
    """
    if not isinstance(parent, ast.Try):
        return False
    is_plain = len(parent.body) == 1 and isinstance(parent.body[0], (ast.Assign, ast.AnnAssign, ast.Expr, ast.Return))
    root = next(node.id for node in nodes_in(message) if isinstance(node, ast.Name))
    for handler in parent.handlers:
        caught = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
        names = {"BaseException" if c is None else last_name(c) for c in caught}
        reads = any(isinstance(node, ast.Name) and node.id == root for s in handler.body for node in nodes_in(s))
        if "AttributeError" in names or ((is_plain or reads) and names & {"Exception", "BaseException"}):
            return True
    return False


def resolved(expression: ast.expr | None, space: dict[str, object]) -> object:
    """Return the value of a possibly dotted name in a module."""
    match expression:
        case ast.Name(id=name):
            return space.get(name)
        case ast.Attribute(value=value, attr=name):
            owner = resolved(value, space)
            if isinstance(owner, ModuleType) and owner.__name__.startswith("graphflow.msgs"):
                return getattr(owner, name, None)  # message classes are built on access
            # Other attributes may be properties, which would run user code.
            return vars(owner).get(name) if isinstance(owner, (ModuleType, type)) else None
        case ast.Constant(value=str(text)):
            return space.get(text)
    return None
