"""Classification of the uses of attributes and names: assigned, called, only read, or passed on to other code.

An escape analysis in miniature. A use that cannot make an object known to other code keeps the world of
`deadlock.closed_world` closed; any use of unknown effect counts as *given* away.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TypeGuard

from graphflow.analysis.syntax import FunctionNode, is_nested, last_name, nodes_in, walk

Kind = Literal["assigned", "changed", "called", "part", "entered", "read", "invoked", "given"]
_LOOKS = (
    *(ast.Compare, ast.BoolOp, ast.UnaryOp, ast.BinOp, ast.If, ast.While, ast.Assert, ast.Await, ast.FormattedValue),
    *(ast.For, ast.AsyncFor, ast.comprehension, ast.Match, ast.Expr),
)
"""Nodes that read the expressions directly below them and do nothing else to them."""
_LOOKING = {"abs", "all", "any", "bool", "dict", "enumerate", "float", "frozenset", "hash", "id", "int", "isinstance"}
_LOOKING |= {"len", "list", "max", "min", "print", "range", "repr", "reversed", "round", "set", "sorted", "str", "sum"}
_LOOKING |= {"super", "tuple", "type", "zip"}
"""Built-in functions that read their arguments and do nothing else to them."""
_AWAITING = {"as_completed", "create_task", "ensure_future", "gather", "isfuture", "shield", "sleep", "timeout"}
_AWAITING |= {"timeout_at", "wait", "wait_for", "wrap_future"}
"""Functions of asyncio that only await their arguments."""
_SAME = {"asarray", "asanyarray", "ascontiguousarray", "reshape", "ravel", "squeeze", "transpose", "swapaxes"}
_SAME |= {"moveaxis", "atleast_1d", "atleast_2d", "expand_dims", "split", "array_split", "broadcast_to", "flip"}
_SAME |= {"diagonal", "copyto"}
"""Functions of numpy that may return another view of the same array, or write to it."""
_CREATORS = {"create_timer", "create_subscription", "create_service"}
"""Methods of nodes that take a callback."""
_RCLPYS = {"ActionServer", "ActionClient", "TransformListener", "TransformBroadcaster", "StaticTransformBroadcaster"}
"""Classes that take the node, and use none of the attributes that its own class defines."""
_SPINNING = {"spin", "spin_once", "spin_until_future_complete", "spin_once_until_future_complete"}
"""rclpy's functions that run a node's callbacks, or wait for a future, and do nothing else to either."""
_ASKING = {"call_async", "send_goal_async", "get_result_async", "cancel_goal_async"}
"""rclpy's methods that return futures of responses."""
_FOLLOWS = "add_done_callback"


@dataclass(frozen=True, slots=True)
class Use:
    """One use of an attribute, or of a name of the module.

    Attributes:
        kind: The kind of use: it is *assigned*; a part of it is *changed* (`self.x.y = 1`, `self.x[0].pop()`); a method
            of it is *called*; a *part* of it is read; it is *entered* by `with`; *read* in a way that cannot change it;
            *invoked*, `self.x()`; or *given* to other code or another name.
        name: The method that is called, or the part.
        value: The assigned expression, if it has one of its own.
        is_nested: Whether it is in a function or lambda inside the method, which may run at any time.
        is_started: Whether it calls an `async def` without awaiting it on the spot, so that it runs by itself.
        is_registered: Whether it is passed to one of the node's `create_...` methods, as a handler is.
        is_lent: Whether it is passed to such a method of another object, such as `node.create_timer`.
        is_answered: Whether it is passed to the future of a response, which will call it.
        part: The whole expression with the part, if that is passed on: `self.x.y[2:]`.
    """

    method: str
    syntax: ast.Attribute | ast.Name
    kind: Kind
    name: str = ""
    value: ast.expr | None = None
    is_nested: bool = False
    is_started: bool = False
    is_registered: bool = False
    is_lent: bool = False
    is_answered: bool = False
    part: ast.expr | None = None


def use_of(method: str, node: ast.Attribute | ast.Name, parents: Sequence[ast.AST]) -> Use:
    """Classify a use by the nodes that enclose it in the method, the outermost first."""
    above = parents[-1]
    nested = is_nested(parents)
    if isinstance(node.ctx, (ast.Store, ast.Del)):
        value = above.value if isinstance(above, (ast.Assign, ast.AnnAssign)) else None
        targets = above.targets if isinstance(above, ast.Assign) else []
        names = {t.id for t in targets if isinstance(t, ast.Name) and t is not node}
        is_shared = any(isinstance(t, ast.Attribute) and t is not node for t in targets)
        if is_shared or not all(_only_looked_at(name, parents[0]) for name in names):
            return Use(method, node, "given", is_nested=nested)
        return Use(method, node, "assigned", value=value, is_nested=nested)
    if isinstance(above, ast.Call) and above.func is node:
        return Use(method, node, "invoked", is_nested=nested)
    # Climb from `self.x` to the whole of `self.x.y[0].z`.
    whole: ast.AST = node
    around = list(parents)
    while isinstance(around[-1], (ast.Attribute, ast.Subscript)) and around[-1].value is whole:
        whole = around.pop()
    if whole is not node:
        name = above.attr if isinstance(above, ast.Attribute) else ""
        if isinstance(whole, (ast.Attribute, ast.Subscript)) and isinstance(whole.ctx, (ast.Store, ast.Del)):
            kind: Kind = "changed"
        elif isinstance(around[-1], ast.Call) and around[-1].func is whole:
            kind = "called" if whole is above else "changed"
        else:
            kind = "part"
        passed_on = whole if isinstance(whole, ast.expr) and kind == "part" and not looks(whole, around) else None
        return Use(method, node, kind, name, is_nested=nested, part=passed_on)
    if isinstance(above, ast.withitem) and above.context_expr is node:
        return Use(method, node, "entered", is_nested=nested)
    kind = "read" if looks(node, around) else "given"
    is_answered = _is_for_answer(above, parents[0])
    is_registered = registers(above)
    is_lent = isinstance(above, ast.Call) and not is_registered and last_name(above.func) in _CREATORS
    return Use(
        method,
        node,
        kind,
        is_nested=nested,
        is_registered=is_registered,
        is_lent=is_lent,
        is_answered=is_answered,
    )


def looks(node: ast.AST, parents: Sequence[ast.AST]) -> bool:
    """Whether a use only reads an object, so that it cannot become known to other code."""
    above = parents[-1]
    if isinstance(above, ast.Starred):
        return looks(above, parents[:-1])
    if isinstance(above, ast.IfExp):
        return above.test is node
    if isinstance(above, (ast.List, ast.Tuple, ast.Set)):  # asyncio.wait([self.x])
        call = parents[-2] if len(parents) > 1 else None
        return isinstance(call, ast.Call) and _awaits(ast.unparse(call.func))
    if isinstance(above, ast.Call):
        function = ast.unparse(above.func)
        if function.startswith("np."):
            return function.removeprefix("np.") not in _SAME
        if function.rpartition(".")[2] in _SPINNING:
            return True
        return function in _LOOKING or function.startswith(("self.log.", "math.")) or _awaits(function)
    return isinstance(above, _LOOKS)


def _awaits(function: str) -> bool:
    return function.startswith("asyncio.") and function.removeprefix("asyncio.") in _AWAITING


def _only_looked_at(name: str, function: ast.AST) -> bool:
    """Whether all uses of a second name of an object only read it."""
    return not any(
        isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Load) and not looks(node, parents)
        for node, parents in walk(function)
    )


def reaches_by_name(call: ast.Call) -> bool:
    """Whether a call reaches a method or attributes by names that the source does not show."""
    match call.func:
        case ast.Call(func=ast.Name(id="getattr"), args=[_, name, *_]):  # getattr(node, name)()
            return not isinstance(name, ast.Constant)
        case ast.Attribute(value=ast.Call(func=ast.Name(id="vars")), attr="update"):  # vars(node).update(...)
            return True
        case _:
            return last_name(call.func) == "methodcaller"


def called_back(method: FunctionNode) -> set[ast.AST]:
    """Return the functions inside a method that are passed to `add_done_callback` and to no other code."""
    uses: dict[str, list[bool]] = {}
    found: set[ast.AST] = set()
    for node, parents in walk(method):
        is_given = bool(parents) and isinstance(above := parents[-1], ast.Call) and last_name(above.func) == _FOLLOWS
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            uses.setdefault(node.id, []).append(is_given)
        elif isinstance(node, ast.Lambda) and is_given:
            found.add(node)
    inner = [node for node in nodes_in(method) if isinstance(node, ast.FunctionDef) and node is not method]
    return found | {function for function in inner if all(uses.get(function.name, [False]))}


def registers(above: ast.AST) -> bool:
    """Whether a node is a call that registers handlers."""
    if not isinstance(above, ast.Call):
        return False
    return ast.unparse(above.func).startswith("self.create_") or last_name(above.func) == "ActionServer"


def _is_for_answer(above: ast.AST, function: ast.AST) -> bool:
    """Whether a call is `add_done_callback` of a future that the function got from `call_async` or a similar method."""
    match above:
        case ast.Call(func=ast.Attribute(value=ast.Call() as made, attr="add_done_callback")):
            return _asks(made)
        case ast.Call(func=ast.Attribute(value=(ast.Name() | ast.Attribute()) as future, attr="add_done_callback")):
            name = ast.unparse(future)
            bound = [
                n.value for n in nodes_in(function) if isinstance(n, ast.Assign) and ast.unparse(n.targets[0]) == name
            ]
            return bool(bound) and all(map(_asks, bound))
    return False


def _asks(value: ast.expr) -> bool:
    return isinstance(value, ast.Call) and last_name(value.func) in _ASKING


def is_awaited(parents: Sequence[ast.AST]) -> bool:
    """Whether a call of an `async def`, whose function has these parents, is awaited on the spot."""
    call, above = parents[-1], parents[-2]
    if isinstance(above, (ast.AsyncFor, ast.comprehension)):
        return above.iter is call
    if isinstance(above, ast.Call) and ast.unparse(above.func) == "asyncio.wait_for":
        above = parents[-3]
    return isinstance(above, (ast.Await, ast.withitem, ast.Return))


def is_gathered(parents: Sequence[ast.AST]) -> bool:
    """Whether a call of an `async def`, whose function has these parents, is a part of `await asyncio.gather(...)`."""
    match parents[:-1]:
        case [*_, ast.Await(), ast.Call(func=function)]:
            return ast.unparse(function) == "asyncio.gather"
        case [*_, ast.Await(), ast.Call(func=function), ast.Starred(), ast.GeneratorExp() | ast.ListComp() as each]:
            return ast.unparse(function) == "asyncio.gather" and each.elt is parents[-1]
    return False


def knows(parents: Sequence[ast.AST], defined: set[str]) -> bool:
    """Whether a call that passes the node leads to code that is analysed, too, or that only reads it."""
    call = parents[-1] if isinstance(parents[-1], ast.Call) else parents[-2]
    if not isinstance(call, ast.Call):
        return False
    is_known = isinstance(call.func, ast.Name) and call.func.id in _LOOKING | _RCLPYS | defined
    return is_known or last_name(call.func) in _SPINNING


def is_part_of(node: ast.expr, owner: str) -> bool:
    """Whether an expression is `self.owner.something`."""
    return isinstance(node, ast.Attribute) and is_own(node.value) and node.value.attr == owner


def is_own(node: ast.AST) -> TypeGuard[ast.Attribute]:
    """Whether an expression is `self.something`."""
    return isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self"


def is_super(node: ast.AST) -> bool:
    """Whether an expression is a call of `super`."""
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "super"
