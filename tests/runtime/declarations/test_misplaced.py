"""Declarations without effect are refused when the class is created."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from types import ModuleType
from typing import Any

import pytest

from graphflow import DeclarationError, Node, Param, Publisher, timer
from graphflow.msgs.std_msgs.msg import String
from graphflow.runtime.node_core import core_of

HEAD = """\
import functools
from graphflow import Node, Param, Publisher, Subscription, timer
from graphflow.msgs.std_msgs.msg import String

def noisy(fn):
    def wrap(*args):
        return fn(*args)
    return wrap

class Kept:
    def __init__(self, fn):
        self.fn = fn

"""


def made(body: str, *, head: str = HEAD) -> Any:
    """The class `N` of a module."""
    module = ModuleType("misplaced_cast")
    sys.modules["misplaced_cast"] = module
    try:
        exec(
            compile(f"{head}class N(Node):\n    {body}\n", "misplaced_cast.py", "exec", dont_inherit=True), vars(module)
        )
        module.N.interface()
        return module.N
    finally:
        del sys.modules["misplaced_cast"]


TICK = "@timer(1.0)\n    def tick(self): ..."


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (
            f"@noisy\n    {TICK}",
            "tick would never run, because the decorator above hides it; @timer goes above @noisy, or",
        ),
        (f"@Kept\n    {TICK}", "@timer goes above @Kept, or functools.wraps"),
        (f"@staticmethod\n    {TICK}", "@timer goes on a plain method; leave out @staticmethod"),
        (f"@property\n    {TICK}", "leave out @property"),
        (
            "rate = Param(1.0)\n    @noisy\n    @rate.check\n    def fits(self, value): ...",
            "fits would never run, because the decorator above hides it; @rate.check goes above @noisy",
        ),
        ('out = Publisher(String, "x"),', ":15: out is a tuple because of the comma after Publisher(...); remove it"),
        ('out: Publisher(String, "x")', ":15: out is only annotated; write = instead of the colon"),
        ("beat: timer(1.0)", ":15: @timer goes above a method; beat is only annotated"),
        (
            'outs = [Publisher(String, f"x{i}") for i in range(3)]',
            "a Publisher in a list is not the node's; give each an attribute of its own, or make them in __init__: "
            "self.outs = [self.create_publisher(...), ...]",
        ),
        ('limits = {"low": Param(1.0)}', "a Param in a dict is not the node's; give each an attribute of its own"),
    ],
)
@pytest.mark.skipif(sys.version_info >= (3, 14), reason="annotations are not evaluated")
def test_what_is_not_found(body: str, told: str) -> None:
    """Each with its line and the way to write it."""
    with pytest.raises(DeclarationError) as caught:
        made(body)
    assert told in str(caught.value)


def test_annotations_that_are_text() -> None:
    """As `from __future__ import annotations` makes them."""
    head = f"from __future__ import annotations\n{HEAD}"
    with pytest.raises(DeclarationError, match=r"N\.out is only annotated, as Publisher\(String, 'x'\); write ="):
        made("out: Publisher(String, 'x')", head=head)
    made("out: list[Publisher[String]]\n    other: timer\n    third: Kept(print)", head=head)


def test_a_handler_beside_the_class() -> None:
    """Is refused, unless some class has it as a method."""
    head = f"{HEAD}\n@timer(1.0)\ndef tick(self): ...\n\n"
    with pytest.raises(DeclarationError, match="@timer goes on a method, and tick is outside a class"):
        made("pass", head=head)
    made("beat = tick", head=head)


def test_what_is_found_all_the_same() -> None:
    """A decorator that keeps the mark, a declaration that is also in a list, and a function that calls a handler."""

    def noisy(fn: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(fn)
        def wrap(*args: Any) -> Any:
            return fn(*args)

        return wrap

    class Careful(Node):
        rate = Param(1.0)
        words = Publisher(String, "words")
        all_of_them = (rate, words)

        @noisy
        @timer(1.0)
        def tick(self) -> None: ...

        again = functools.partialmethod(tick)

    assert [handler.name for handler in Careful.interface().handlers] == ["tick"]


def test_a_declaration_in_a_method() -> None:
    """Is none of the node's: it belongs into the body of the class."""

    class Late(Node):
        def __init__(self) -> None:
            super().__init__()
            self.words = Publisher(String, "words")

    with pytest.raises(DeclarationError) as caught:
        core_of(Late()).ensure_made()
    assert str(caught.value).endswith(
        "self.words is not a Publisher of the node; write words = Publisher(...) in the body of the class, "
        "or self.words = self.create_publisher(...) here"
    )


def test_hooks_are_awaited() -> None:
    """A `def` must return an awaitable."""
    with pytest.raises(DeclarationError, match=r":15: on_start is awaited; write async def on_start\(self\)"):
        made("def on_start(self):\n        print('up')")
    with pytest.raises(DeclarationError, match="on_shutdown is awaited"):
        made("def on_shutdown(self):\n        if self.name:\n            return\n        print('down')")
    with pytest.raises(DeclarationError, match=r"does not await N.__init__; write def __init__, and await in async"):
        made("async def __init__(self):\n        super().__init__()")
    way = r"the node itself calls on_start: leave out its decorator, or give a handler a name of its own"
    with pytest.raises(DeclarationError, match=way):
        made("@timer(1.0)\n    async def on_start(self): ...")
    made("def on_start(self):\n        return self.begin()\n    async def begin(self): ...")
