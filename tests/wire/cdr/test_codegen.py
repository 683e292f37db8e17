"""Layouts of runs of numbers, and the least room a type takes."""

from __future__ import annotations

import pytest

from graphflow.errors import EncodeError
from graphflow.msgs import registry
from graphflow.wire import idl
from graphflow.wire.cdr.codegen import Code, Item, Types, layout_of, min_size, padding
from graphflow.wire.schema import FieldType, Message
from tests.cases import sample
from tests.wire.messages import message_names
from tests.wire.slow_cdr import Writer


def types() -> Types:
    def refuse(message: object) -> object:
        raise EncodeError(f"{message!r}")

    return Types(registry.message_schema, registry.interface_class, refuse)


@pytest.mark.parametrize("start", range(16))
def test_a_layout_aligns_from_after_the_header(start: int) -> None:
    """Wherever a run starts, each number lies at a multiple of its size, counted from after the header."""
    items = [Item(f, "") for f in "BhBiBqfBd"]
    layout = layout_of(items, start, "<")
    buffer = bytearray(layout.size)
    layout.pack_into(buffer, 0, 1, 2, 3, 4, 5, 6, 7.0, 8, 9.0)
    twin = Writer(registry.message_schema)
    twin.payload, twin.padding = bytearray(start), []
    for base, value in zip(
        ["uint8", "int16", "uint8", "int32", "uint8", "int64", "float32", "uint8", "float64"], range(1, 10), strict=True
    ):
        twin.number(base, value)
    assert buffer == twin.payload[start:]


def test_a_layout_has_the_order_asked_for() -> None:
    """Little- and big-endian layouts differ in nothing else."""
    items = [Item("H", ""), Item("I", "")]
    assert layout_of(items, 4, "<").pack(1, 2).hex() == "0100000002000000"
    assert layout_of(items, 4, ">").pack(1, 2).hex() == "0001000000000002"


@pytest.mark.parametrize("widest", [1, 2, 4, 8])
def test_padding_reaches_the_next_multiple(widest: int) -> None:
    """From any position the padding leads to an aligned one, and is no longer than needed."""
    for position in range(4, 24):
        count = len(padding(widest)[position & (widest - 1)])
        assert count < widest
        assert (position + count - 4) % widest == 0


def test_names_in_the_code_are_never_the_same() -> None:
    """Objects that the code refers to each get a name of their own."""
    code = Code(types(), "<", {})
    names = [code.constant("S", i) for i in range(5)] + [code.fresh("S") for _ in range(5)]
    assert len(set(names)) == 10
    assert [code.names[n] for n in names[:5]] == list(range(5))


def test_a_run_at_a_known_position_has_a_known_size() -> None:
    """While the position is fixed a run is one struct; afterwards there is one for each alignment."""
    code = Code(types(), "<", {})
    code.number("B", "a")
    code.number("d", "b")
    code.number("x", "")
    run = code.take_run("pack")
    assert run is not None
    assert run[1:] == (["a", "b"], 17)
    assert code.position == 4 + 17
    code.position = None
    code.number("d", "c")
    run = code.take_run("pack")
    assert run is not None
    assert run[0].endswith("[p & 7]")
    assert run[2] is None
    assert code.take_run("pack") is None


@pytest.mark.parametrize(
    ("text", "size"),
    [
        ("bool", 1),
        ("float64", 8),
        ("uint16[5]", 10),
        ("uint16[]", 4),
        ("uint16[<=5]", 4),
        ("string", 4),
        ("string<=5[3]", 12),
        ("wstring", 4),
        ("std_msgs/Empty", 1),
        ("std_msgs/Empty[7]", 7),
        ("std_msgs/Header", 12),
        ("std_msgs/Header[2]", 24),
        ("std_msgs/Header[]", 4),
    ],
)
def test_least_sizes(text: str, size: int) -> None:
    """The least room of a type is its numbers' sizes and four bytes for each length."""
    assert min_size(idl.parse_type(text, "pkg"), registry.message_schema) == size


@pytest.mark.parametrize("name", sample(message_names()))
def test_no_message_is_smaller_than_its_least_size(name: str) -> None:
    """A message with nothing in its sequences takes at least the room that is asked for it."""
    least = min_size(FieldType(name), registry.message_schema)
    payload = registry.example(name).to_bytes()
    assert 0 < least <= len(payload) - 4


def test_code_knows_where_it_came_from() -> None:
    """A traceback through generated code names the message."""
    code = Code(types(), "<", {})
    code.line("raise ZeroDivisionError")
    made = code.compile("f", "def f():", Message("pkg/msg/Thing").name)
    assert made.__code__.co_filename == "<pkg/msg/Thing>"
    with pytest.raises(ZeroDivisionError):
        made()
