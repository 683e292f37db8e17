"""What the source of a node's class shows: its methods, which calls which, and all that is done to an attribute.

Read once for each class, from the files of the class and of its parents. Whatever may do more than it shows, such as
`setattr`, a method that is passed on instead of called, or the node itself given to code of another file, makes the
source unusable: `Unknown`.
"""

from __future__ import annotations

import ast
import dataclasses
import inspect
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from types import CodeType
from typing import Any, Literal, NamedTuple

from graphflow.deadlock.fresh import messages_of
from graphflow.deadlock.syntax import FunctionNode, Syntax, first_line, is_nested, syntax_of, walk
from graphflow.deadlock.user_code import is_users_module

Kind = Literal["assigned", "changed", "called", "part", "entered", "read", "invoked", "given"]
_LOOKS = (
    *(ast.Compare, ast.BoolOp, ast.UnaryOp, ast.BinOp, ast.If, ast.While, ast.Assert, ast.Await, ast.FormattedValue),
    *(ast.For, ast.AsyncFor, ast.comprehension, ast.Match, ast.Expr),
)
_LOOKING = {"abs", "all", "any", "bool", "dict", "enumerate", "float", "frozenset", "hash", "id", "int", "isinstance"}
_LOOKING |= {"len", "list", "max", "min", "print", "range", "repr", "reversed", "round", "set", "sorted", "str", "sum"}
_LOOKING |= {"super", "tuple", "type", "zip"}
_AWAITING = {"as_completed", "create_task", "ensure_future", "gather", "isfuture", "shield", "sleep", "timeout"}
_AWAITING |= {"timeout_at", "wait", "wait_for", "wrap_future"}
"""Functions of asyncio that do to what they are given nothing but await it."""
_SAME = {"asarray", "asanyarray", "ascontiguousarray", "reshape", "ravel", "squeeze", "transpose", "swapaxes"}
_SAME |= {"moveaxis", "atleast_1d", "atleast_2d", "expand_dims", "split", "array_split", "broadcast_to", "flip"}
_SAME |= {"diagonal", "copyto"}
"""Functions of numpy that may return another view of the same array, or write to it."""
_INTERCEPTING = {"__setattr__", "__delattr__", "__getattribute__"}
"""Methods by which attributes change in ways that their names do not show."""
_RCLPYS = {"ActionServer", "ActionClient", "TransformListener", "TransformBroadcaster", "StaticTransformBroadcaster"}
"""Classes that are given the node, and do nothing to attributes that it has of its own."""
_ASKING = {"call_async", "send_goal_async", "get_result_async", "cancel_goal_async"}
"""rclpy's methods whose futures are done when an answer has been taken."""
_BY_NAME = {"setattr", "delattr", "vars", "exec", "eval", "locals"}


LAMBDA = "<lambda>"
"""What Python calls all of them."""


class Unknown(Exception):
    """The source does not say."""


class Function(NamedTuple):
    """A method, or a function inside one."""

    syntax: FunctionNode
    method: str
    """The method that it is, or that contains it."""


@dataclass(frozen=True, slots=True)
class Use:
    """One mention of an attribute, or of a name of the module.

    Attributes:
        kind: What is done: it is *assigned*; a part of it is *changed* (`self.x.y = 1`, `self.x[0].pop()`); a method
            of it is *called*; a *part* is looked at; it is *entered* by `with`; *read* where that cannot change it;
            *invoked*, `self.x()`; or *given* to other code or another name.
        name: The method that is called, or the part.
        value: What is assigned, if that is an expression of its own.
        is_nested: In a function or lambda inside the method, which may run at any time.
        is_started: A call of an `async def` that is not awaited on the spot and runs on its own.
        is_registered: Given to one of the node's `create_...`, as a handler is.
        is_answered: Given to the future of an answer, which calls it.
        part: The whole of what is looked at, where it is passed on: `self.x.y[2:]`.
    """

    method: str
    syntax: ast.Attribute | ast.Name
    kind: Kind
    name: str = ""
    value: ast.expr | None = None
    is_nested: bool = False
    is_started: bool = False
    is_registered: bool = False
    is_answered: bool = False
    part: ast.expr | None = None


@dataclass
class ClassSource:
    """The methods of a class and its parents."""

    methods: dict[str, list[FunctionNode]] = field(default_factory=dict)
    """Methods by name: the child's, and its parents' where those are called by `super()`."""
    rebound: set[str] = field(default_factory=set)
    """Module-level names that some function rebinds."""
    _others: dict[str, FunctionNode] = field(default_factory=dict)
    """Functions of the files, by name."""
    _functions: dict[tuple[str, int], Function] = field(default_factory=dict)
    """Functions by file and first line."""
    _files: list[Syntax] = field(default_factory=list)
    _uses: dict[str, list[Use]] = field(default_factory=dict)
    _foreign: dict[str, list[Use]] = field(default_factory=dict)
    """Mentions on anything other than `self`, anywhere in the files."""
    _callers: dict[str, set[str]] = field(default_factory=dict)
    _properties: set[str] = field(default_factory=set)
    _globals: dict[Syntax, dict[str, Any]] = field(default_factory=dict)
    """What the names of each file mean."""
    _handlers: set[str] = field(default_factory=set)
    """Methods that are given to one of the node's `create_...`."""
    _is_known: bool = True

    def function(self, code: CodeType) -> Function | None:
        """The source of a method, or of a function inside one, by its code."""
        return self._functions.get((code.co_filename, code.co_firstlineno))

    def uses(self, attribute: str) -> list[Use]:
        """All that the class's methods do to `self.attribute`.

        Raises:
            Unknown: The source may not show everything that is done to it.
        """
        if not self._is_known:
            raise Unknown
        return self._uses.get(attribute, [])

    def foreign(self, attribute: str, owner: str = "") -> list[Use]:
        """What is done to an attribute of that name on anything other than `self`, and other than `self.owner`."""
        found = self._foreign.get(attribute, [])
        return [use for use in found if not (owner and _is_part_of(use.syntax, owner))]

    def above(self, methods: set[str], handlers: set[str], owner: str = "") -> set[str]:
        """Those methods and all that call them, directly or through each other.

        Args:
            methods: Names of methods.
            handlers: Methods that graphflow calls, which may be given to it.
            owner: The attribute by which a node holds the object; what is done by way of it counts there.

        Raises:
            Unknown: Some other code may call one of them.
        """
        found, todo = set(methods), list(methods)
        while todo:
            method = todo.pop()
            self._refuse_strangers(method, method in handlers, owner)
            for caller in self._callers.get(method, set()) - found:
                found.add(caller)
                todo.append(caller)
        return found

    def below(self, method: str) -> set[str]:
        """A method and all that it calls."""
        found, todo = {method}, [method]
        while todo:
            caller = todo.pop()
            called = {name for name, callers in self._callers.items() if caller in callers} - found
            found |= called
            todo += called
        return found

    def may_fail(self, block: ast.AST, methods: set[str]) -> bool:
        """Whether, as far as can be seen, an error raised in what a block calls may leave the block.

        Args:
            methods: The methods that the block calls, and those that they call.
        """
        blocks = [block, *(function for name in methods for function in self.methods.get(name, []))]
        called = {
            n.func.id for b in blocks for n in ast.walk(b) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)
        }
        blocks += [self._others[name] for name in called & set(self._others)]
        return any(isinstance(node, (ast.Raise, ast.Assert)) for b in blocks[1:] for node in ast.walk(b))

    def _refuse_strangers(self, method: str, is_handler: bool, owner: str) -> None:
        for use in self.uses(method):
            calls = use.kind == "invoked" or method in self._properties
            is_begun = (is_handler and use.is_registered) or use.is_answered
            if use.is_nested or use.is_started or not (calls or is_begun):
                raise Unknown
        if self.foreign(method, owner):
            raise Unknown

    # how it is read

    def _add(self, cls: type, file: str, syntax: Syntax, continued: set[str]) -> None:
        """The methods of one class."""
        if syntax not in self._files:
            self._files.append(syntax)
            self._globals[syntax] = vars(sys.modules.get(cls.__module__, object))
            self._others |= {item.name: item for item in syntax.module.body if isinstance(item, FunctionNode)}
        written = {function for function in map(_code_of, vars(cls).values()) if function is not None}
        if dataclasses.is_dataclass(cls):  # which makes methods that do what the fields say
            written = {code for code in written if code.co_filename != "<string>"}
        self._is_known &= not _INTERCEPTING & vars(cls).keys()
        self._is_known &= all(code.co_filename == file for code in written)  # none put there by other code
        self._is_known &= all(code.co_firstlineno in syntax.method_lines for code in written)
        for definition in syntax.classes:
            if definition.name != cls.__name__:
                continue
            for item in definition.body:
                if not (isinstance(item, FunctionNode) and _is_of(cls, item)):
                    continue
                for inner in ast.walk(item):
                    if isinstance(inner, FunctionNode):
                        self._functions[file, first_line(inner)] = Function(inner, item.name)
                if item.name not in self.methods or item.name in continued:
                    self.methods.setdefault(item.name, []).append(item)
                    continued |= {node.attr for node in ast.walk(item) if _is_of_super(node)}  # type: ignore[attr-defined]

    def _link(self) -> None:
        """Find out what is done to which attribute, and which method calls which."""
        inside: set[ast.AST] = set()
        self._handlers = {
            node.attr
            for functions in self.methods.values()
            for function in functions
            for node, parents in walk(function)
            if isinstance(node, ast.Attribute) and is_own(node) and _registers(parents[-1])
        }
        defined = {name for syntax in self._files for name in syntax.defined}
        for name, functions in self.methods.items():
            for function in functions:
                lambdas = {
                    n: above for n, above in walk(function) if isinstance(n, ast.Lambda) and _registers(above[-1])
                }
                decorators = {ast.unparse(decorator) for decorator in function.decorator_list}
                if decorators & {"property", "cached_property", "functools.cached_property"}:
                    self._properties.add(name)
                if not decorators & {"staticmethod", "classmethod"} and (
                    not function.args.args or function.args.args[0].arg != "self"
                ):
                    self._is_known = False
                for node, parents in walk(function):
                    inside.add(node)
                    handler = next((n for n in parents if n in lambdas), None)
                    if isinstance(node, ast.Attribute) and handler is not None:
                        self._note(LAMBDA, node, parents[parents.index(handler) :])
                    elif isinstance(node, ast.Attribute):
                        self._note(name, node, parents)
                    elif isinstance(node, ast.Name):
                        self._is_known &= node.id not in _BY_NAME
                        if node.id == "self" and isinstance(parents[-1], (ast.Call, ast.keyword)):
                            self._is_known &= _knows(parents, defined)
        for syntax in self._files:
            for node, parents in syntax.parts:
                if isinstance(node, ast.Global):
                    self.rebound.update(node.names)
                if isinstance(node, ast.Call) and _word(node.func) in ("setattr", "delattr") and node not in inside:
                    self._set_by_name(node)
                if not isinstance(node, ast.Attribute) or node in inside or _is_super(node.value):
                    continue
                if is_own(node) and any(isinstance(parent, ast.ClassDef) for parent in parents):
                    continue  # of another class; in a function of the module, `self` may be the node
                if not (isinstance(node.value, ast.Name) and node.value.id in syntax.imported):
                    self._note_foreign("", node, parents, syntax)

    def _set_by_name(self, call: ast.Call) -> None:
        """`setattr(other, "ready", True)`."""
        match call:
            case ast.Call(args=[ast.Name(id="self"), *_]):
                pass  # of another class
            case ast.Call(args=[owner, ast.Constant(value=str(name)), *_]):
                syntax = ast.copy_location(ast.Attribute(owner, name, ast.Store()), call)
                self._foreign.setdefault(name, []).append(Use("", syntax, "assigned"))
            case _:
                self._is_known = False

    def _note_foreign(
        self, method: str, node: ast.Attribute, parents: Sequence[ast.AST], syntax: Syntax | None
    ) -> None:
        """What is done to an attribute of something other than the node; of a message it is none of the node's."""
        root: ast.expr = node
        while isinstance(root, (ast.Attribute, ast.Subscript)):
            root = root.value
        function = next((p for p in reversed(parents) if isinstance(p, FunctionNode)), None)
        if syntax is not None and function is not None and isinstance(root, ast.Name):
            if function not in syntax.fresh:
                syntax.fresh[function] = messages_of(function, self._globals[syntax])
            if root.id in syntax.fresh[function]:
                return
            given = {a.arg for a in function.args.args[1:]} - {
                n.id for n in ast.walk(function) if isinstance(n, ast.Name) and not isinstance(n.ctx, ast.Load)
            }
            if function.name in self._handlers and root.id in given and function is parents[0]:
                return  # what handlers are called with are messages, requests and responses
        self._foreign.setdefault(node.attr, []).append(use_of(method, node, parents))

    def _note(self, method: str, node: ast.Attribute, parents: Sequence[ast.AST]) -> None:
        if not (is_own(node) or _is_super(node.value)):
            syntax = next((s for s in self._files if parents[0] in s.nodes), None)
            self._note_foreign(method, node, parents, syntax)
            return
        use = use_of(method, node, parents)
        if node.attr == "__dict__":
            self._is_known = False
        if node.attr in self.methods:
            is_async = any(isinstance(f, ast.AsyncFunctionDef) for f in self.methods[node.attr])
            if is_async and use.kind == "invoked" and not _is_awaited(parents):
                use = Use(method, node, use.kind, is_nested=use.is_nested, is_started=True)
            if node.attr != method:
                self._callers.setdefault(node.attr, set()).add(method)
        if is_own(node):
            self._uses.setdefault(node.attr, []).append(use)


def _code_of(member: object) -> CodeType | None:
    """The code of a method as it was written, beneath its decorators."""
    member = member.fget if isinstance(member, property) else getattr(member, "__func__", member)
    return getattr(inspect.unwrap(member), "__code__", None) if callable(member) else None


def source_of(instance: object) -> ClassSource:
    """The source of an object's class."""
    cls: Any = type(instance)
    return _source_of(cls)


@cache
def _source_of(cls: Any) -> ClassSource:
    """The source of a class; parents that are graphflow's or Python's own are left out."""
    source, continued = ClassSource(), set[str]()
    for parent in cls.__mro__:
        if not is_users_module(parent.__module__):
            continue
        try:
            file = inspect.getsourcefile(parent) or ""
            source._add(parent, file, syntax_of(file), continued)
        except (OSError, SyntaxError, TypeError, ValueError):  # there is none: what its methods do is not known
            source._is_known = False
    source._link()
    return source


def use_of(method: str, node: ast.Attribute | ast.Name, parents: Sequence[ast.AST]) -> Use:
    """What a method does to what an expression stands for, by what encloses it there, the outermost first."""
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
    # `self.x.y[0].z`: up to the whole of it.
    whole: ast.AST = node
    around = list(parents)
    while isinstance(around[-1], (ast.Attribute, ast.Subscript)) and around[-1].value is whole:
        whole = around.pop()
    if whole is not node:
        name = above.attr if isinstance(above, ast.Attribute) else ""
        if isinstance(whole.ctx, (ast.Store, ast.Del)):  # type: ignore[attr-defined]
            kind: Kind = "changed"
        elif isinstance(around[-1], ast.Call) and around[-1].func is whole:
            kind = "called" if whole is above else "changed"
        else:
            kind = "part"
        handed = whole if isinstance(whole, ast.expr) and kind == "part" and not looks(whole, around) else None
        return Use(method, node, kind, name, is_nested=nested, part=handed)
    if isinstance(above, ast.withitem) and above.context_expr is node:
        return Use(method, node, "entered", is_nested=nested)
    kind = "read" if looks(node, around) else "given"
    is_answered = _is_for_answer(above, parents[0])
    return Use(method, node, kind, is_nested=nested, is_registered=_registers(above), is_answered=is_answered)


def looks(node: ast.AST, parents: Sequence[ast.AST]) -> bool:
    """Whether a mention cannot make what is mentioned known to other code."""
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
        return function in _LOOKING or function.startswith(("self.log.", "math.")) or _awaits(function)
    return isinstance(above, _LOOKS)


def _awaits(function: str) -> bool:
    return function.startswith("asyncio.") and function.removeprefix("asyncio.") in _AWAITING


def _only_looked_at(name: str, function: ast.AST) -> bool:
    """Whether a second name of something is only used to look at it."""
    return not any(
        isinstance(node, ast.Name) and node.id == name and isinstance(node.ctx, ast.Load) and not looks(node, parents)
        for node, parents in walk(function)
    )


def _word(function: ast.expr) -> str:
    return function.id if isinstance(function, ast.Name) else ""


def _registers(above: ast.AST) -> bool:
    if not isinstance(above, ast.Call):
        return False
    function = ast.unparse(above.func)
    return function.startswith("self.create_") or function.rpartition(".")[2] == "ActionServer"


def _is_for_answer(above: ast.AST, function: ast.AST) -> bool:
    """Whether a call is `add_done_callback` of a future that `call_async` and the like have made in the function."""
    match above:
        case ast.Call(func=ast.Attribute(value=ast.Call() as made, attr="add_done_callback")):
            return _asks(made)
        case ast.Call(func=ast.Attribute(value=(ast.Name() | ast.Attribute()) as future, attr="add_done_callback")):
            name = ast.unparse(future)
            bound = [
                n.value for n in ast.walk(function) if isinstance(n, ast.Assign) and ast.unparse(n.targets[0]) == name
            ]
            return bool(bound) and all(map(_asks, bound))
    return False


def _asks(value: ast.expr) -> bool:
    return isinstance(value, ast.Call) and ast.unparse(value.func).rpartition(".")[2] in _ASKING


def _is_awaited(parents: Sequence[ast.AST]) -> bool:
    """Whether a call of a coroutine, whose function has these parents, runs on the spot and nowhere else."""
    call, above = parents[-1], parents[-2]
    if isinstance(above, (ast.AsyncFor, ast.comprehension)):
        return above.iter is call
    if isinstance(above, ast.Call) and ast.unparse(above.func) == "asyncio.wait_for":
        above = parents[-3]
    return isinstance(above, (ast.Await, ast.withitem, ast.Return))


def _knows(parents: Sequence[ast.AST], defined: set[str]) -> bool:
    """Whether a call that receives the node leads to code that is read here too, or that only looks at it."""
    call = parents[-1] if isinstance(parents[-1], ast.Call) else parents[-2]
    return (
        isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in _LOOKING | _RCLPYS | defined
    )


def _is_part_of(node: ast.expr, owner: str) -> bool:
    part = node.value if isinstance(node, ast.Attribute) else None
    return isinstance(part, ast.Attribute) and part.attr == owner and is_own(part)


def is_own(node: ast.AST) -> bool:
    """Whether an expression is `self.something`."""
    return isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self"


def _is_super(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "super"


def _is_of_super(node: ast.AST) -> bool:
    return isinstance(node, ast.Attribute) and _is_super(node.value)


def _is_of(cls: type, item: FunctionNode) -> bool:
    """Whether a function is this class's method, not that of another class of the same name."""
    held: Any = vars(cls).get(item.name)
    held = held.fget if isinstance(held, property) else getattr(held, "__func__", held)
    code = getattr(inspect.unwrap(held), "__code__", None)
    return code is not None and code.co_firstlineno == first_line(item)
