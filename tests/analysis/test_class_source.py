"""What is read of a class's source: what is done to an attribute, who calls whom, and when the source says nothing."""

from __future__ import annotations

import ast
import textwrap
from types import ModuleType
from typing import Any

import pytest

from graphflow.analysis.attribute_uses import Use
from graphflow.analysis.class_source import ClassSource, Unknown, source_of
from tests.written import Written

HEAD = """
import asyncio
import math

import numpy as np

def keep(thing): ...
"""


def read(written: Written, text: str) -> ClassSource:
    """The source of the class `N` in a text."""
    return source_of(made(written, text).N())


def made(written: Written, text: str) -> ModuleType:
    return written(HEAD + textwrap.dedent(text))


def uses_of_x(written: Written, statement: str) -> list[Use]:
    """What one statement does to `self.x`."""
    body = textwrap.indent(statement, " " * 8)
    source = read(
        written, f"class N:\n    async def go(self, a=0, b=0, other=None):\n{body}\n    def plan(self): ...\n"
    )
    uses = source.uses("x")
    assert all(use.method == "go" and isinstance(use.syntax, ast.Attribute) for use in uses)
    return uses


@pytest.mark.parametrize(
    ("statement", "kind", "name"),
    [
        ("self.x = 1", "assigned", ""),
        ("self.x: int = 1", "assigned", ""),
        ("self.x += 1", "assigned", ""),
        ("del self.x", "assigned", ""),
        ("for self.x in a: pass", "assigned", ""),
        ("self.x, b = a", "assigned", ""),
        ("b = self.x = []", "assigned", ""),
        ("b = self.x = []\nprint(len(b))", "assigned", ""),
        ("b = self.x = []\nkeep(b)", "given", ""),
        ("self.y = self.x = []", "given", ""),
        ("self.x.y = 1", "changed", "y"),
        ("self.x.y += 1", "changed", "y"),
        ("del self.x.y", "changed", "y"),
        ("self.x[0] = 1", "changed", ""),
        ("self.x[0].y = 1", "changed", ""),
        ("self.x[0].pop()", "changed", ""),
        ("self.x.y.pop()", "changed", "y"),
        ("self.x.pop()", "called", "pop"),
        ("await self.x.wait()", "called", "wait"),
        ("b = self.x.y", "part", "y"),
        ("b = self.x[0]", "part", ""),
        ("b = self.x.y > 0", "part", "y"),
        ("with self.x: pass", "entered", ""),
        ("async with self.x: pass", "entered", ""),
        ("with self.x as b: pass", "entered", ""),
        ("self.x()", "invoked", ""),
        ("await self.x(a)", "invoked", ""),
        ("if self.x: pass", "read", ""),
        ("while not self.x: pass", "read", ""),
        ("assert self.x", "read", ""),
        ("b = self.x + 1", "read", ""),
        ("b = self.x is None and a", "read", ""),
        ("b = a if self.x else b", "read", ""),
        ("b = f'{self.x}'", "read", ""),
        ("for b in self.x: pass", "read", ""),
        ("b = [a for a in self.x]", "read", ""),
        ("await self.x", "read", ""),
        ("print(len(self.x))", "read", ""),
        ("print(*self.x)", "read", ""),
        ("print(math.sqrt(self.x))", "read", ""),
        ("self.log.info('%s', self.x)", "read", ""),
        ("await asyncio.wait_for(self.x, 1.0)", "read", ""),
        ("await asyncio.wait([self.x])", "read", ""),
        ("await asyncio.to_thread(keep, self.x)", "given", ""),
        ("asyncio.get_running_loop().call_soon(keep, self.x)", "given", ""),
        ("b = np.sum(self.x)", "read", ""),
        ("match self.x:\n    case 1: pass", "read", ""),
        ("b = np.asarray(self.x)", "given", ""),
        ("b = self.x", "given", ""),
        ("b = self.x if a else b", "given", ""),
        ("b = [self.x]", "given", ""),
        ("return self.x", "given", ""),
        ("keep(self.x)", "given", ""),
        ("keep(thing=self.x)", "given", ""),
        ("other.y = self.x", "given", ""),
        ("self.y = self.x", "given", ""),
        ("super().x", "", ""),
        ("other.x = 1", "", ""),
    ],
)
def test_what_a_statement_does_to_an_attribute(written: Written, statement: str, kind: str, name: str) -> None:
    """Whatever could change it, or make it known to somebody who could, is told from what only looks."""
    found = [(use.kind, use.name) for use in uses_of_x(written, statement)]

    assert found == ([(kind, name)] if kind else [])


@pytest.mark.parametrize(
    ("statement", "flags"),
    [
        ("print(self.x)", set()),
        ("def inner():\n    self.x = 1", {"is_nested"}),
        ("keep(lambda: self.x.pop())", {"is_nested"}),
        ("self.create_timer(1.0, self.x)", {"is_registered"}),
        ("node.create_timer(1.0, self.x)", {"is_lent"}),
        ("keep(self.x)", set()),
    ],
)
def test_how_a_statement_does_it(written: Written, statement: str, flags: set[str]) -> None:
    """Functions inside of a method run nobody knows when; and a handler may be given to the node's own `create_`."""
    [use] = uses_of_x(written, statement)

    assert {flag for flag in ("is_nested", "is_registered", "is_lent", "is_started") if getattr(use, flag)} == flags


@pytest.mark.parametrize(
    ("statement", "value", "part"),
    [
        ("self.x = a + 1", "a + 1", None),
        ("self.x: int = a", "a", None),
        ("self.x += 1", None, None),
        ("b = self.x[2:].y", None, "self.x[2:].y"),
        ("print(self.x[2:].y)", None, None),
    ],
)
def test_what_is_assigned_and_what_is_handed_on(
    written: Written, statement: str, value: str | None, part: str | None
) -> None:
    """The expression itself, if it is one of its own; the whole of a part that somebody gets."""
    [use] = uses_of_x(written, statement)

    found = [None if each is None else ast.unparse(each) for each in (use.value, use.part)]
    assert found == [value, part]


@pytest.mark.parametrize(
    ("statement", "is_started"),
    [
        ("await self.run()", False),
        ("return self.run()", False),
        ("await asyncio.wait_for(self.run(), 1.0)", False),
        ("async with self.run(): pass", False),
        ("async for _ in self.run(): pass", False),
        ("self.task = asyncio.create_task(self.run())", True),
        ("coroutine = self.run()", True),
        ("await asyncio.gather(self.run(), other())", False),
        ("await asyncio.gather(*(self.run() for _ in range(2)))", False),
        ("await asyncio.gather(*[self.run() for _ in range(2)])", False),
        ("await asyncio.gather(*(other(self.run()) for _ in range(2)))", True),
        ("running = asyncio.gather(self.run(), other())", True),
        ("await asyncio.shield(self.run())", True),
        ("self.plain()", False),
    ],
)
def test_calls_that_run_on_their_own(written: Written, statement: str, is_started: bool) -> None:
    """An `async def` that is called and not awaited on the spot runs nobody knows when."""
    source = read(
        written,
        f"""
        class N:
            async def go(self):
                {statement}
            async def run(self): ...
            def plain(self): ...
        """,
    )

    [use] = [*source.uses("run"), *source.uses("plain")]
    assert (use.kind, use.is_started) == ("invoked", is_started)
    assert source.gathered == ({"run"} if "gather(" in statement and not is_started else set())


# What makes the source say nothing


@pytest.mark.parametrize(
    "statement",
    [
        "setattr(self, name, 1)",
        "delattr(self, name)",
        "vars(self)['x'] = 1",
        "self.__dict__['x'] = 1",
        "exec(name)",
        "eval(name)",
        "locals()",
        "math.sqrt(self)",
        "math.sqrt(thing=self)",
        "name.append(self)",
    ],
)
def test_statements_that_may_do_anything(written: Written, statement: str) -> None:
    """Nothing is said of a class of which one method names attributes at run time, or gives the node away."""
    source = read(written, f"class N:\n    def go(self, name):\n        {statement}\n")

    with pytest.raises(Unknown):
        source.uses("x")


@pytest.mark.parametrize(
    "statement",
    [
        "keep(self)",
        "print(self)",
        "Other(self)",
        "isinstance(self, int)",
        "name == self",
        "self.go(name)",
        "print(name)",
    ],
)
def test_statements_that_do_not(written: Written, statement: str) -> None:
    """The node may be given to code of its own file, which is read too, and to what only looks at it."""
    text = f"class Other: ...\nclass N:\n    def go(self, name):\n        {statement}\n"

    assert read(written, text).uses("x") == []


@pytest.mark.parametrize(
    ("method", "is_known"),
    [
        ("def go(me): me.x = 1", False),
        ("def go(): ...", False),
        ("@staticmethod\n    def go(me): ...", True),
        ("@classmethod\n    def go(cls): ...", True),
    ],
)
def test_methods_without_self(written: Written, method: str, is_known: bool) -> None:
    """A method that calls its node by another name is not understood."""
    source = read(written, f"class N:\n    {method}\n")

    if is_known:
        assert source.uses("x") == []
    else:
        with pytest.raises(Unknown):
            source.uses("x")


def test_a_class_without_source() -> None:
    """Nobody knows what its methods do."""
    space: dict[str, Any] = {"__name__": "nowhere"}
    exec("class N:\n    def go(self): ...", space)

    with pytest.raises(Unknown):
        source_of(space["N"]()).uses("x")


# The rest of the file


@pytest.mark.parametrize(
    ("text", "kinds"),
    [
        ("def outside(n):\n    n.x = 1", ["assigned"]),
        ("def outside(n):\n    n.x.append(1)", ["called"]),
        ("def outside(n):\n    keep(n.x)", ["given"]),
        ("class Other:\n    def go(self, n):\n        n.x = 1", ["assigned"]),
        ("class Other:\n    def go(self):\n        self.x = 1", []),
        ("def outside(n):\n    setattr(n, 'x', 1)", ["assigned"]),
        ("print(math.x)", []),
    ],
)
def test_what_others_do(written: Written, text: str, kinds: list[str]) -> None:
    """An attribute of that name of anything but `self` counts, wherever in the file; a module's does not."""
    text = f"class N:\n    def go(self): ...\ndef later():\n{textwrap.indent(text, '    ')}\n"

    assert [use.kind for use in read(written, text).foreign("x")] == kinds


def test_a_method_that_touches_another_object(written: Written) -> None:
    """That is told with the method in which it stands."""
    [use] = read(written, "class N:\n    def go(self, other):\n        other.x = 1\n").foreign("x")

    assert (use.kind, use.method) == ("assigned", "go")


def test_attributes_set_by_a_name_that_is_not_written(written: Written) -> None:
    """Some function of the file may set any attribute of anything."""
    source = read(written, "class N:\n    def go(self): ...\ndef outside(n, name):\n    setattr(n, name, 1)\n")

    with pytest.raises(Unknown):
        source.uses("x")


def test_names_that_are_bound_anew(written: Written) -> None:
    """A global that some function binds is no constant."""
    source = read(written, "limit = 3\nclass N: ...\ndef outside():\n    global limit\n    limit = 4\n")

    assert source.rebound == {"limit"}


# Who calls whom

CALLS = """
class N:
    def on_go(self): self.step()
    def on_scan(self): self.step(); self.note()
    def step(self): self.move()
    def move(self): self.x = 1
    def note(self): ...
    @property
    def state(self): return self.level
    def ask(self): print(self.state)
    def register(self): self.create_timer(1.0, self.on_go)
    def hand_on(self): keep(self.note)
    async def run(self): ...
    def begin(self): asyncio.create_task(self.run())
"""


@pytest.mark.parametrize(
    ("methods", "above"),
    [
        ({"move"}, {"move", "step", "on_go", "on_scan", "register"}),
        ({"step"}, {"step", "on_go", "on_scan", "register"}),
        ({"on_go"}, {"on_go", "register"}),
        ({"state"}, {"state", "ask"}),
        (set(), set()),
    ],
)
def test_who_calls_a_method(written: Written, methods: set[str], above: set[str]) -> None:
    """All that call it, directly or through each other; who registers a handler is one of them."""
    assert read(written, CALLS).above(methods, {"on_go", "on_scan"}) == above


@pytest.mark.parametrize("method", ["note", "run", "on_go"])
def test_methods_that_others_may_call(written: Written, method: str) -> None:
    """One that is given away, or started, or registered and no handler, is called nobody knows when."""
    with pytest.raises(Unknown):
        read(written, CALLS).above({method}, set())


def test_a_method_that_is_lent_to_another_node(written: Written) -> None:
    """That node may call a node's own method at any time; an object's is called back by the node that owns it."""
    source = read(written, CALLS.replace("self.create_timer", "other.create_timer"))
    lent = next(name for name in source.methods if any(use.is_lent for use in source.uses(name)))
    with pytest.raises(Unknown):
        source.above({lent}, {lent})
    assert lent in source.above({lent}, {lent}, "owner")


def test_a_method_that_another_object_has_too(written: Written) -> None:
    """A call of that name on anything but `self` may be a call of the node's."""
    source = read(written, CALLS + "def outside(n):\n    n.move()\n")

    with pytest.raises(Unknown):
        source.above({"move"}, set())


def test_what_a_method_calls(written: Written) -> None:
    """All of it, and what that calls."""
    source = read(written, CALLS)

    assert source.below("on_scan") == {"on_scan", "step", "move", "note"}
    assert source.below("move") == {"move"}


@pytest.mark.parametrize(
    ("body", "may"),
    [
        ("self.checks()", True),
        ("guard()", True),
        ("self.works()", False),
        ("print(self.x)", False),
        ("raise ValueError", False),
    ],
)
def test_blocks_that_may_be_left_by_an_error(written: Written, body: str, may: bool) -> None:
    """An error that is raised in what a block calls, be it a method or a function of the file, leaves it.

    What the block itself raises stands in it, and is looked at there.
    """
    source = read(
        written,
        f"""
        def guard():
            assert False
        class N:
            def go(self):
                while True:
                    {body}
            def checks(self): raise ValueError
            def works(self): ...
        """,
    )
    [go] = source.methods["go"]
    called = {node.attr for node in ast.walk(go) if isinstance(node, ast.Attribute)} & set(source.methods)

    assert source.may_fail(go.body[0], called) is may


# Whose methods


def test_parents_and_children(written: Written) -> None:
    """The child's methods count, the parent's only where they are inherited or called by `super`."""
    module = made(
        written,
        """
        class Parent:
            def kept(self): self.a = 1
            def replaced(self): self.b = 1
            def continued(self): self.c = 1

        class N(Parent):
            def replaced(self): self.b = 2
            def continued(self):
                super().continued()
                self.c = 2
        """,
    )
    source = source_of(module.N())

    assert {name: len(functions) for name, functions in source.methods.items()} == {
        "kept": 1,
        "replaced": 1,
        "continued": 2,
    }
    assert [len(source.uses(name)) for name in "abc"] == [1, 1, 2]
    assert len(source_of(module.Parent()).uses("b")) == 1


def test_two_classes_of_one_name(written: Written) -> None:
    """Only the class itself is read, and not another that has its name."""
    source = read(
        written,
        """
        def make():
            class N:
                def go(self): self.x = 1
            return N

        class N:
            def come(self): self.x = 2
        """,
    )

    assert list(source.methods) == ["come"]


def test_functions_by_their_code(written: Written) -> None:
    """Methods, decorated ones and properties too, and functions inside of them are found by file and first line."""
    module = made(
        written,
        """
        def same(function): return function

        class N:
            @same
            def go(self):
                def inner(): ...
                return inner
            @property
            def state(self): ...

        def outside(): ...
        """,
    )
    node = module.N()
    source = source_of(node)

    found = {
        code: source.function(code)
        for code in (node.go.__code__, node.go().__code__, module.N.state.fget.__code__, module.outside.__code__)
    }
    assert [None if f is None else (f.syntax.name, f.method) for f in found.values()] == [
        ("go", "go"),
        ("inner", "go"),
        ("state", "state"),
        None,
    ]


def test_a_class_is_read_once(written: Written) -> None:
    """Every object of it has the same source."""
    module = made(written, "class N: ...")

    assert source_of(module.N()) is source_of(module.N())
