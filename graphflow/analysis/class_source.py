"""The source of a node's class: its methods, its call graph, and every use of its attributes.

It is read once per class, from the files of the class and of its parents. Code whose effects the source does not show,
such as `setattr`, a method that is passed on instead of called, or the node itself passed to code of another file,
makes the source unusable: `Unknown`.
"""

from __future__ import annotations

import ast
import dataclasses
import inspect
import sys
from collections.abc import Mapping, Sequence
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
)
from graphflow.analysis.local_messages import messages_of
from graphflow.analysis.syntax import FunctionNode, Syntax, first_line, nodes_in, syntax_of, walk
from graphflow.analysis.user_code import is_users_module

_INTERCEPTING = {"__setattr__", "__delattr__", "__getattribute__"}
"""Methods by which attributes change without being named."""
_BY_NAME = {"setattr", "delattr", "vars", "exec", "eval", "locals", "methodcaller"}
"""Functions that reach attributes by names that are computed."""


LAMBDA = "<lambda>"
"""Method name of every lambda that is registered as a handler, as in `co_name`."""
ANSWERED = "__answered__"
"""Method name of every inner function that a future calls when a response has arrived."""


class Unknown(Exception):
    """The source does not show everything that may happen."""


class Function(NamedTuple):
    """A method, or a function inside one."""

    syntax: FunctionNode
    method: str
    """Name of the method that it is, or that contains it."""


@dataclass
class ClassSource:
    """The methods of a class and its parents, with the uses of its attributes."""

    methods: dict[str, list[FunctionNode]] = field(default_factory=dict)
    """Methods by name: the child's, and its parents' if it calls those by `super()`."""
    rebound: set[str] = field(default_factory=set)
    """Module-level names that some function rebinds."""
    _others: dict[str, FunctionNode] = field(default_factory=dict)
    """Functions of the files, by name."""
    _functions: dict[tuple[str, int], Function] = field(default_factory=dict)
    """Functions by file and first line."""
    _files: list[Syntax] = field(default_factory=list)
    _uses: dict[str, list[Use]] = field(default_factory=dict)
    """By attribute: its uses on `self`."""
    _foreign: dict[str, list[Use]] = field(default_factory=dict)
    """By attribute: its uses on anything other than `self`, anywhere in the files."""
    _callers: dict[str, set[str]] = field(default_factory=dict)
    """By method: the methods that call it."""
    _properties: set[str] = field(default_factory=set)
    _globals: dict[Syntax, Mapping[str, object]] = field(default_factory=dict)
    """By file: the global names."""
    _handlers: set[str] = field(default_factory=set)
    """Methods that are passed to one of the node's `create_...` methods."""
    gathered: set[str] = field(default_factory=set)
    """Methods that run as parts of an `asyncio.gather` in the class."""
    _is_known: bool = True
    """Whether the source shows everything that is done to the attributes."""

    def function(self, code: CodeType) -> Function | None:
        """Return the source of a method, or of a function inside one."""
        return self._functions.get((code.co_filename, code.co_firstlineno))

    def uses(self, attribute: str) -> list[Use]:
        """Return the uses of `self.attribute` in the class's methods.

        Raises:
            Unknown: There may be uses that the source does not show.
        """
        if not self._is_known:
            raise Unknown
        return self._uses.get(attribute, [])

    def foreign(self, attribute: str, owner: str = "") -> list[Use]:
        """Return the uses of an attribute of that name on anything other than `self` and `self.owner`."""
        found = self._foreign.get(attribute, [])
        return [use for use in found if not (owner and is_part_of(use.syntax, owner))]

    def above(self, methods: set[str], handlers: set[str], owner: str = "") -> set[str]:
        """Return some methods and all methods that call them, directly or through each other.

        Args:
            methods: Names of methods.
            handlers: Methods that graphflow calls, and that may therefore be passed to it.
            owner: The attribute of a node with the object, if this is the source of an object that a node owns; uses
                through that attribute belong to the node's source.

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
        """Return a method and all methods that it calls, directly or through each other."""
        found, todo = {method}, [method]
        while todo:
            caller = todo.pop()
            called = {name for name, callers in self._callers.items() if caller in callers} - found
            found |= called
            todo += called
        return found

    def may_fail(self, block: ast.AST, methods: set[str]) -> bool:
        """Whether an exception raised in code that a block calls may leave the block, by the `raise` statements seen.

        Args:
            methods: The methods that the block calls, and those that they call.
        """
        blocks = [block, *(function for name in methods for function in self.methods.get(name, []))]
        called = {
            n.func.id for b in blocks for n in nodes_in(b) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)
        }
        blocks += [self._others[name] for name in called & set(self._others)]
        return any(isinstance(node, (ast.Raise, ast.Assert)) for b in blocks[1:] for node in nodes_in(b))

    def _refuse_strangers(self, method: str, is_handler: bool, owner: str) -> None:
        for use in self.uses(method):
            calls = use.kind == "invoked" or method in self._properties
            is_begun = (is_handler and (use.is_registered or (use.is_lent and owner))) or use.is_answered
            is_elsewhere = use.is_started or (owner and method in self.gathered)
            if use.is_nested or is_elsewhere or not (calls or is_begun):
                raise Unknown
        if self.foreign(method, owner):
            raise Unknown

    # construction

    @classmethod
    def of(cls, described: type) -> ClassSource:
        """Read the source of a class; parents of graphflow's or Python's own are left out."""
        source, continued = cls(), set[str]()
        for parent in described.__mro__:
            if is_users_module(parent.__module__):
                source.add(parent, continued)
        source.link()
        return source

    def add(self, cls: type, continued: set[str]) -> None:
        """Add the methods of one class; its children come before it.

        Args:
            continued: Methods that a child calls by `super()`; those of this class are added.
        """
        try:
            file = inspect.getsourcefile(cls) or ""
            self._add_source(cls, file, syntax_of(file), continued)
        except (OSError, SyntaxError, TypeError, ValueError):  # no source, so its methods may do anything
            self._is_known = False

    def _add_source(self, cls: type, file: str, syntax: Syntax, continued: set[str]) -> None:
        if syntax not in self._files:
            self._files.append(syntax)
            self._globals[syntax] = vars(sys.modules.get(cls.__module__, object))
            self._others |= {item.name: item for item in syntax.module.body if isinstance(item, FunctionNode)}
        written = {function for function in map(_code_of, vars(cls).values()) if function is not None}
        if dataclasses.is_dataclass(cls):  # its generated methods do nothing but what the fields say
            written = {code for code in written if code.co_filename not in ("<string>", dataclasses.__file__)}
        self._is_known &= not _INTERCEPTING & vars(cls).keys()
        self._is_known &= all(code.co_filename == file for code in written)  # no method was put there by other code
        self._is_known &= all(code.co_firstlineno in syntax.method_lines for code in written)
        items = (item for d in syntax.classes if d.name == cls.__name__ for item in d.body)
        for item in items:
            if not (isinstance(item, FunctionNode) and _is_of(cls, item)):
                continue
            for inner in nodes_in(item):
                if isinstance(inner, FunctionNode):
                    self._functions[file, first_line(inner)] = Function(inner, item.name)
            if item.name not in self.methods or item.name in continued:
                self.methods.setdefault(item.name, []).append(item)
                supers = (n for n in nodes_in(item) if isinstance(n, ast.Attribute) and is_super(n.value))
                continued |= {node.attr for node in supers}

    def link(self) -> None:
        """Find the uses of all attributes, and the callers of all methods, after the last `add`."""
        inside: set[ast.AST] = set()
        self._handlers = {
            node.attr
            for functions in self.methods.values()
            for function in functions
            for node, parents in walk(function)
            if is_own(node) and registers(parents[-1])
        }
        defined = {name for syntax in self._files for name in syntax.defined}
        for name, functions in self.methods.items():
            for function in functions:
                self._note_signature(name, function)
                inside |= self._link_method(name, function, defined)
        for syntax in self._files:
            self._link_rest(syntax, inside)

    def _note_signature(self, name: str, function: FunctionNode) -> None:
        decorators = {ast.unparse(decorator) for decorator in function.decorator_list}
        if decorators & {"property", "cached_property", "functools.cached_property"}:
            self._properties.add(name)
        arguments = function.args.args
        if not decorators & {"staticmethod", "classmethod"} and (not arguments or arguments[0].arg != "self"):
            self._is_known = False  # the object has another name than `self`, by which its uses are found

    def _link_method(self, name: str, function: FunctionNode, defined: set[str]) -> set[ast.AST]:
        """Note the uses of attributes in one method; return its nodes.

        Args:
            defined: Names of the classes and functions in the files, whose code is analysed, too.
        """
        # Inner functions that run as handlers count as methods of their own.
        handlers: dict[ast.AST, str] = {
            n: LAMBDA for n, above in walk(function) if isinstance(n, ast.Lambda) and registers(above[-1])
        }
        handlers |= dict.fromkeys(called_back(function), ANSWERED)
        inside: set[ast.AST] = set()
        for node, parents in walk(function):
            inside.add(node)
            if isinstance(node, ast.Attribute):
                handler = next((n for n in parents if n in handlers), None)
                if handler is None:
                    self._note(name, node, parents)
                else:
                    self._note(handlers[handler], node, parents[parents.index(handler) :])
            elif isinstance(node, ast.Name):
                self._is_known &= node.id not in _BY_NAME
                if node.id == "self" and isinstance(parents[-1], (ast.Call, ast.keyword)):
                    self._is_known &= knows(parents, defined)
        return inside

    def _link_rest(self, syntax: Syntax, inside: set[ast.AST]) -> None:
        """Note the uses of attributes in a file outside the class's methods, which are `inside`."""
        for node, parents in syntax.parts:
            if isinstance(node, ast.Global):
                self.rebound.update(node.names)
            elif isinstance(node, ast.Call):
                self._is_known &= not reaches_by_name(node)
                is_setter = isinstance(node.func, ast.Name) and node.func.id in ("setattr", "delattr")
                if is_setter and node not in inside:
                    self._set_by_name(node)
            elif isinstance(node, ast.Attribute) and node not in inside and not is_super(node.value):
                if is_own(node) and any(isinstance(parent, ast.ClassDef) for parent in parents):
                    continue  # `self` is of another class; but in a function of the module it may be the node
                if not (isinstance(node.value, ast.Name) and node.value.id in syntax.imported):
                    self._note_foreign("", node, parents, syntax)

    def _set_by_name(self, call: ast.Call) -> None:
        """Note `setattr(other, "ready", True)` as an assignment."""
        match call:
            case ast.Call(args=[ast.Name(id="self"), *_]):
                pass  # `self` is of another class
            case ast.Call(args=[owner, ast.Constant(value=str(name)), *_]):
                syntax = ast.copy_location(ast.Attribute(owner, name, ast.Store()), call)
                self._foreign.setdefault(name, []).append(Use("", syntax, "assigned"))
            case _:
                self._is_known = False

    def _note_foreign(
        self, method: str, node: ast.Attribute, parents: Sequence[ast.AST], syntax: Syntax | None
    ) -> None:
        """Note a use of an attribute on something other than the node, unless that is known to be a message."""
        root: ast.expr = node
        while isinstance(root, (ast.Attribute, ast.Subscript)):
            root = root.value
        function = next((p for p in reversed(parents) if isinstance(p, FunctionNode)), None)
        if syntax is not None and function is not None and isinstance(root, ast.Name):
            if function not in syntax.fresh:
                syntax.fresh[function] = messages_of(function, self._globals[syntax])
            if root.id in syntax.fresh[function]:
                return
            arguments = {a.arg for a in function.args.args[1:]} - {
                n.id for n in nodes_in(function) if isinstance(n, ast.Name) and not isinstance(n.ctx, ast.Load)
            }
            if function.name in self._handlers and root.id in arguments and function is parents[0]:
                return  # the arguments of handlers are messages, requests and responses
        self._foreign.setdefault(node.attr, []).append(use_of(method, node, parents))

    def _note(self, method: str, node: ast.Attribute, parents: Sequence[ast.AST]) -> None:
        """Note a use of an attribute in a method, and the call if it is one."""
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
    """Return the code of a method as it was written, beneath its decorators."""
    member = member.fget if isinstance(member, property) else getattr(member, "__func__", member)
    return getattr(inspect.unwrap(member), "__code__", None) if callable(member) else None


def source_of(instance: object) -> ClassSource:
    """Return the source of an object's class."""
    cls: Any = type(instance)  # a type checker takes no class for hashable
    return _source_of(cls)


@cache
def _source_of(cls: type) -> ClassSource:
    return ClassSource.of(cls)


def _is_of(cls: type, item: FunctionNode) -> bool:
    """Whether a function is this class's method, not that of another class of the same name in the file."""
    member: Any = vars(cls).get(item.name)
    member = member.fget if isinstance(member, property) else getattr(member, "__func__", member)
    code = getattr(inspect.unwrap(member), "__code__", None)
    return code is not None and code.co_firstlineno == first_line(item)
