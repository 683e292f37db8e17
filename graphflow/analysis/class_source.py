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
from typing import Any, NamedTuple

from graphflow.analysis.attribute_uses import (
    Use,
    called_back,
    is_awaited,
    is_gathered,
    is_own,
    is_part_of,
    is_super,
    knows,
    reaches_by_name,
    registers,
    use_of,
    word,
)
from graphflow.analysis.local_messages import messages_of
from graphflow.analysis.syntax import FunctionNode, Syntax, first_line, syntax_of, walk
from graphflow.analysis.user_code import is_users_module

_INTERCEPTING = {"__setattr__", "__delattr__", "__getattribute__"}
"""Methods by which attributes change in ways that their names do not show."""
_BY_NAME = {"setattr", "delattr", "vars", "exec", "eval", "locals", "methodcaller"}


LAMBDA = "<lambda>"
"""What Python calls all of them."""
ANSWERED = "__answered__"
"""What is called here a function inside a method that is called when an answer has come."""


class Unknown(Exception):
    """The source does not say."""


class Function(NamedTuple):
    """A method, or a function inside one."""

    syntax: FunctionNode
    method: str
    """The method that it is, or that contains it."""


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
    gathered: set[str] = field(default_factory=set)
    """Methods that run as parts of an `asyncio.gather` of the class's own."""
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
        return [use for use in found if not (owner and is_part_of(use.syntax, owner))]

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
            is_elsewhere = use.is_started or (owner and method in self.gathered)
            if use.is_nested or is_elsewhere or not (calls or is_begun):
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
            written = {code for code in written if code.co_filename not in ("<string>", dataclasses.__file__)}
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
            if isinstance(node, ast.Attribute) and is_own(node) and registers(parents[-1])
        }
        defined = {name for syntax in self._files for name in syntax.defined}
        for name, functions in self.methods.items():
            for function in functions:
                begun: dict[ast.AST, str] = {
                    n: LAMBDA for n, above in walk(function) if isinstance(n, ast.Lambda) and registers(above[-1])
                }
                begun |= dict.fromkeys(called_back(function), ANSWERED)
                decorators = {ast.unparse(decorator) for decorator in function.decorator_list}
                if decorators & {"property", "cached_property", "functools.cached_property"}:
                    self._properties.add(name)
                if not decorators & {"staticmethod", "classmethod"} and (
                    not function.args.args or function.args.args[0].arg != "self"
                ):
                    self._is_known = False
                for node, parents in walk(function):
                    inside.add(node)
                    handler = next((n for n in parents if n in begun), None)
                    if isinstance(node, ast.Attribute) and handler is not None:
                        self._note(begun[handler], node, parents[parents.index(handler) :])
                    elif isinstance(node, ast.Attribute):
                        self._note(name, node, parents)
                    elif isinstance(node, ast.Name):
                        self._is_known &= node.id not in _BY_NAME
                        if node.id == "self" and isinstance(parents[-1], (ast.Call, ast.keyword)):
                            self._is_known &= knows(parents, defined)
        for syntax in self._files:
            for node, parents in syntax.parts:
                if isinstance(node, ast.Global):
                    self.rebound.update(node.names)
                if isinstance(node, ast.Call) and reaches_by_name(node):
                    self._is_known = False
                if isinstance(node, ast.Call) and word(node.func) in ("setattr", "delattr") and node not in inside:
                    self._set_by_name(node)
                if not isinstance(node, ast.Attribute) or node in inside or is_super(node.value):
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
        if not (is_own(node) or is_super(node.value)):
            syntax = next((s for s in self._files if parents[0] in s.nodes), None)
            self._note_foreign(method, node, parents, syntax)
            return
        use = use_of(method, node, parents)
        if node.attr == "__dict__":
            self._is_known = False
        if node.attr in self.methods:
            is_async = any(isinstance(f, ast.AsyncFunctionDef) for f in self.methods[node.attr])
            if is_async and use.kind == "invoked" and not is_awaited(parents):
                if is_gathered(parents):
                    self.gathered.add(node.attr)
                else:
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


def _is_of_super(node: ast.AST) -> bool:
    return isinstance(node, ast.Attribute) and is_super(node.value)


def _is_of(cls: type, item: FunctionNode) -> bool:
    """Whether a function is this class's method, not that of another class of the same name."""
    held: Any = vars(cls).get(item.name)
    held = held.fget if isinstance(held, property) else getattr(held, "__func__", held)
    code = getattr(inspect.unwrap(held), "__code__", None)
    return code is not None and code.co_firstlineno == first_line(item)
