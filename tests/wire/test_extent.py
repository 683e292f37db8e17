"""The extent of types, and types of unbounded size."""

from __future__ import annotations

import pytest

from graphflow.errors import InterfaceError
from graphflow.msgs import registry
from graphflow.wire import idl
from graphflow.wire.described import FIELDS_BOUND
from graphflow.wire.extent import DEPTH_BOUND, Extent, extent
from graphflow.wire.schema import Message
from tests.cases import slow

from .messages import message_names


def size_of(**texts: str) -> Extent:
    found = {f"p/msg/{name}": idl.parse(f"p/msg/{name}", text) for name, text in texts.items()}
    schemas = {name: message for name, message in found.items() if isinstance(message, Message)}
    return extent("p/msg/A", schemas.__getitem__)


def test_what_is_counted() -> None:
    """Fields wherever they are used, and the values that an empty message has."""
    assert size_of(A="") == (1, 0, 1)
    assert size_of(A="int32 x\nstring[] y\nuint8[7] z") == (1, 3, 9)
    assert size_of(A="B x\nB y", B="int32 x\nint32 y") == (2, 6, 4)
    assert size_of(A="B[] x\nB[3] y", B="C c\nC d", C="") == (3, 6, 8)


def test_a_type_in_itself() -> None:
    """Has no end, however it comes about."""
    for texts in ({"A": "A a"}, {"A": "B[] b", "B": "A[<=2] a"}, {"A": "int32 x\nB b", "B": "C c", "C": "B b"}):
        with pytest.raises(InterfaceError, match="a message cannot contain itself: p/msg/"):
            size_of(**texts)


def test_how_deep_types_may_be() -> None:
    """So deep that whatever calls itself for each still can; also where the deep end was met before."""
    chain = {f"A{n}": f"A{n + 1} x" for n in range(DEPTH_BOUND)}
    last = f"A{DEPTH_BOUND}"
    assert size_of(A="A2 x", **{**chain, last: ""}).depth == DEPTH_BOUND
    for text in ("A1 x", "A2 x\nA1 y", "A2 x\nB y"):
        with pytest.raises(InterfaceError, match="p/msg/A: more than 50 levels of nested types"):
            size_of(A=text, **{**chain, last: ""}, B="A2 x")


@slow
def test_ros_types_are_far_from_the_bounds() -> None:
    """Types with ten times the fields and the depth of the largest that there are can be used."""
    sizes = [extent(name, registry.message_schema) for name in message_names()]
    assert max(size.fields for size in sizes) * 10 < FIELDS_BOUND
    assert max(size.depth for size in sizes) * 4 < DEPTH_BOUND
