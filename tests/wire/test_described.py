"""Definitions from elsewhere: described and read back, and what is refused."""

from __future__ import annotations

import tracemalloc
from itertools import pairwise

import pytest

from graphflow.errors import InterfaceError
from graphflow.msgs import registry
from graphflow.wire.cdr.codec import Codec
from graphflow.wire.described import DescribedField, definition_of, verified
from graphflow.wire.schema import Field, Message
from graphflow.wire.typehash import base_of, referenced, type_id
from tests.cases import sample, slow

from .messages import types_of


def said(field: Field) -> DescribedField:
    t = field.type
    return DescribedField(field.name, type_id(t), t.size, t.string_bound, "" if t.is_primitive else t.base)


def described(message: Message) -> dict[str, str]:
    """All texts that a description of a type gives."""
    parts = {message.name: message, **referenced(message, registry.message_schema)}
    return {name: definition_of(name, [said(f) for f in part.fields]) for name, part in parts.items()}


MESSAGES = [f"{package}/msg/{name}" for package in registry.packages() for name in registry.names_in(package, "msg")]


@pytest.mark.parametrize("name", sample(MESSAGES))
def test_a_description_has_the_hash_of_its_definition(name: str) -> None:
    """Whatever the type: what it is described by is enough to talk to it."""
    texts = described(registry.message_schema(name))
    assert set(verified(name, registry.hash_of(name), texts)) == set(texts)


@pytest.mark.parametrize("name", ["std_srvs/srv/SetBool", "example_interfaces/action/Fibonacci"])
def test_services_and_actions(name: str) -> None:
    """Come with their files."""
    whole = registry.whole_schema(name)
    files = {name: registry.definition(name)}
    for other in referenced(whole, registry.message_schema):
        if "/msg/" in other:
            files[other] = registry.definition(other)
    assert verified(name, registry.hash_of(name), files)


def test_a_type_without_fields() -> None:
    """Is described by one that is hidden."""
    assert (
        definition_of("std_msgs/msg/Empty", [DescribedField("structure_needs_at_least_one_member", 3, 0, 0, "")]) == ""
    )


@pytest.mark.parametrize("number", [-1, 0, 12, 14, 19, 20, 23, 48, 96, 192, 255])
def test_numbers_of_no_type(number: int) -> None:
    """Are no type, and no error of another kind."""
    assert base_of(number) is None
    with pytest.raises(InterfaceError, match=f"p/msg/A: field 'x' is of the unknown type {number}"):
        definition_of("p/msg/A", [DescribedField("x", number, 0, 0, "")])


FIXED = "uint8[1000] x\n"


def nested(depth: int, text: str) -> dict[str, str]:
    """Definitions in each other, each with `text`, where `{0}` is the next."""
    names = ["A", *(f"A{n}" for n in range(1, depth))]
    texts = {f"p/msg/{name}": text.format(inner) for name, inner in pairwise(names)}
    return {**texts, f"p/msg/{names[-1]}": "uint8 z"}


BOMBS = {
    "fields": (nested(21, "{0} x\n{0} y"), "more than 20,000 fields"),
    "lists": (nested(21, "{0}[] x\n{0}[] y"), "more than 20,000 fields"),
    "more fields than can be counted out": (
        nested(50, "".join(f"{{0}} x{n}\n" for n in range(100))),
        "more than 20,000 fields",
    ),
    "depth": (nested(500, "{0} x"), "more than 50 levels of nested types"),
    "depth and width": (nested(500, "{0} x\n{0} y"), "more than 50 levels of nested types"),
}


@pytest.mark.timeout(20)
@pytest.mark.parametrize(("sources", "message"), BOMBS.values(), ids=BOMBS)
def test_types_that_multiply(sources: dict[str, str], message: str) -> None:
    """Are refused before anything is made of them, in little time and memory."""
    tracemalloc.start()
    try:
        with pytest.raises(InterfaceError, match=message):
            verified("p/msg/A", "", sources)
        assert tracemalloc.get_traced_memory()[1] < 20_000_000
    finally:
        tracemalloc.stop()


@pytest.mark.timeout(60)
@pytest.mark.parametrize("text", [pytest.param("{0} x\n{0} y", marks=slow), "{0}[] x\n{0}[] y"])
def test_the_largest_that_are_not_refused(text: str) -> None:
    """Can be read and written within bounds, too: no decoder is written twice."""
    found = verified("p/msg/A", "", nested(13, text))
    types = types_of(found)
    tracemalloc.start()
    try:
        codec = Codec(found["p/msg/A"], types)  # type: ignore[arg-type]
        assert callable(codec.encode)
        assert codec.decode(bytes([0, 1, 0, 0]) + bytes(8192))
        assert tracemalloc.get_traced_memory()[1] < 200_000_000
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(
    ("sources", "message"),
    [
        ({"p/msg/A": "int32 x"}, "has the hash RIHS01_.*, not RIHS01_00, which was announced"),
        ({"p/msg/A": "B b"}, "its definition lacks p/msg/B"),
        ({"p/msg/B": "int32 x"}, "its definition lacks p/msg/A"),
        ({}, "its definition lacks p/msg/A"),
        ({"p/msg/A": "B b", "p/msg/B": "A a"}, "a message cannot contain itself: p/msg/A in p/msg/B in p/msg/A"),
        ({"p/msg/A": "A a"}, "a message cannot contain itself: p/msg/A in p/msg/A"),
        (
            {"p/msg/A": "uint8[1000001] x"},
            "p/msg/A: an empty message would have more than 1,000,000 values; if that is intended",
        ),
        ({"p/msg/A": "B[1000] b", "p/msg/B": "uint8[2000] x"}, "would have more than 1,000,000 values"),
        ({"p/msg/A": "import os\n"}, "import"),
        ({"p/msg/A": "int32 x; import os"}, "x;"),
        ({"p/msg/A": "int32 class"}, "keyword"),
        ({"p/msg/A": f"#{'x' * 1_000_000}"}, "is too large"),
        ({"p/msg/A": "B[1000000000] b", "p/msg/B": ""}, "would have more than 1,000,000 values"),
        (nested(49, "{0}[%d] x" % 10**17), "would have more than 1,000,000 values"),  # noqa: UP031 - braces stay
        ({"p/msg/A": f"string<={'9' * 5000} x"}, "a line that is too long"),
        ({"p/msg/A": f"string<={'9' * 500} x"}, "is not a type"),
        ({"p/msg/A": "string[] x [" + "'," * 600 + "]"}, "a line that is too long"),
        ({"p/msg/A": "", **{f"p/msg/A{n}": "" for n in range(500)}}, "is too large"),
        ({"p/msg/A": "", "../../etc": ""}, "has an illegal type name"),
        ({"p/msg/A": "", "p/exe/A": ""}, "has an illegal type name"),
        ({"p/msg/A": "", "p/msg/../A": ""}, "has an illegal type name"),
        ({"p/msg/A": "", "p/msg/a b": ""}, "type name 'a b'"),
    ],
)
def test_what_is_refused(sources: dict[str, str], message: str) -> None:
    """All that is not the type that was announced, or that would cost too much."""
    with pytest.raises(InterfaceError, match=message):
        verified("p/msg/A", "RIHS01_00", sources)


def test_any_hash_will_do_where_none_was_announced() -> None:
    """Old bags have none."""
    assert list(verified("p/msg/A", "", {"p/msg/A": "int32 x"})) == ["p/msg/A"]


def test_what_is_not_needed_is_left_out() -> None:
    """A node cannot plant the definition of another type."""
    sources = {"p/msg/A": "B b", "p/msg/B": "int32 x", "p/msg/Planted": "int32 y"}
    assert set(verified("p/msg/A", "", sources)) == {"p/msg/A", "p/msg/B"}
